// Draws the curves of each scene and the buttons that show and hide them; without Plotly the still pictures stay.
"use strict";
(function () {
  if (!window.Plotly) return;
  const figures = JSON.parse(document.getElementById("figures").textContent);

  function button(text, className, colour) {
    const made = document.createElement("button");
    made.type = "button";
    made.textContent = text;
    made.className = className;
    made.setAttribute("aria-pressed", "true");
    if (colour) made.style.setProperty("--c", colour);
    return made;
  }

  function addChips(home, plot, traces) {
    const all = [];
    const show = (chosen, on) => {
      chosen.forEach((index) => all[index].setAttribute("aria-pressed", String(on)));
      Plotly.restyle(plot, { visible: on }, chosen);
    };
    const groups = new Map();
    traces.forEach((trace, index) => {
      if (!groups.has(trace.group)) groups.set(trace.group, []);
      groups.get(trace.group).push(index);
    });
    groups.forEach((members, name) => {
      if (home.childElementCount) home.append(Object.assign(document.createElement("span"), { className: "break" }));
      const whole = button(name, "group");
      whole.onclick = () => {
        const on = whole.getAttribute("aria-pressed") === "false";
        whole.setAttribute("aria-pressed", String(on));
        show(members, on);
      };
      home.append(whole);
      members.forEach((index) => {
        const one = (all[index] = button(traces[index].name, "", traces[index].ink));
        one.onclick = () => show([index], one.getAttribute("aria-pressed") === "false");
        home.append(one);
      });
    });
    home.hidden = false;
  }

  function draw(plot) {
    const figure = figures[Number(plot.dataset.scene)];
    const article = plot.closest("article");
    const narrow = window.innerWidth < 640;
    const layout = Object.assign({}, figure.layout, narrow ? { height: 360, margin: { l: 56, r: 6, t: 6, b: 46 } } : {});
    if (narrow) layout.yaxis = Object.assign({}, layout.yaxis, { title: { text: "" } });
    plot.hidden = false;
    Plotly.newPlot(plot, figure.data, layout, { responsive: true, displayModeBar: false, scrollZoom: false });
    addChips(article.querySelector(".chips"), plot, figure.data);
    article.querySelector(".still").style.display = "none";
  }

  // One after another, so that the page can be read at once.
  const waiting = Array.from(document.querySelectorAll(".curves"));
  (function next() {
    const plot = waiting.shift();
    if (!plot) {
      document.body.dataset.drawn = "all";
      return;
    }
    draw(plot);
    setTimeout(next, 0);
  })();
})();
