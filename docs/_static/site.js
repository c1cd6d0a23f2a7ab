// The still of the first page becomes the film, and the films and the playground follow the colours of the site.
"use strict";
(function () {
  const system = window.matchMedia("(prefers-color-scheme: dark)");
  const theme = () => {
    const chosen = document.body.dataset.theme;
    return chosen === "light" || chosen === "dark" ? chosen : system.matches ? "dark" : "light";
  };
  const canDraw = () => {
    try { return Boolean(document.createElement("canvas").getContext("webgl2")); } catch { return false; }
  };

  function start(box) {
    const frame = document.createElement("iframe");
    const address = () => `_static/film.html#within&theme=${theme()}`;
    frame.title = "A film: the block turns, and its angular velocity moves on the ellipsoid";
    frame.src = address();
    frame.addEventListener("load", () => box.classList.add("runs"), { once: true });
    const follow = () => { if (!frame.src.endsWith(address())) frame.src = address(); };
    new MutationObserver(follow).observe(document.body, { attributes: true, attributeFilter: ["data-theme"] });
    system.addEventListener("change", follow);
    box.append(frame);
  }

  window.addEventListener("load", () => {
    const box = document.querySelector(".turning");
    if (box && canDraw()) start(box);
  });
})();
