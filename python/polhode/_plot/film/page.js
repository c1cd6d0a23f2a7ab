// Turns the body and moves the tip of omega at the time of the slider.
"use strict";
(function () {
  const film = JSON.parse(document.getElementById("film").textContent);
  const find = (id) => document.getElementById(id);
  const system = window.matchMedia("(prefers-color-scheme: dark)"), root = document.documentElement;
  const isDark = () => (root.dataset.theme ? root.dataset.theme === "dark" : system.matches);
  const hue = (pair) => (isDark() ? pair.dark : pair.light);
  const ink = () => getComputedStyle(document.documentElement).getPropertyValue("--quiet").trim();

  // A page that frames a film says in the address how it is to look: #within&theme=dark
  function dress() {
    const theme = /[#&]theme=(light|dark)/.exec(location.hash);
    if (theme) root.dataset.theme = theme[1]; else delete root.dataset.theme;
    root.toggleAttribute("data-within", /[#&]within/.test(location.hash));
  }
  dress();

  function unpack(text) {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    return new Float32Array(bytes.buffer);
  }
  const attitude = unpack(film.attitude);

  // A canvas with a camera that a drag, the arrow keys and the wheel move around the middle. Space z points up.
  function makeView(canvas, azimuth, elevation, reach) {
    const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
    const scene = new THREE.Scene();
    const camera = new THREE.PerspectiveCamera(30, 1, 0.1, 50);
    camera.up.set(0, 0, 1);
    const light = new THREE.DirectionalLight(0xffffff, 1.7);
    scene.add(new THREE.HemisphereLight(0xffffff, 0xbbbbbb, 2.3), light);
    const lines = [];
    const view = { scene, lines, dirty: true };

    view.line = function (points, colour, width, faint) {
      const geometry = new THREE.LineGeometry();
      geometry.setPositions(points);
      const material = new THREE.LineMaterial({ linewidth: width, transparent: true, opacity: faint || 1 });
      const line = new THREE.Line2(geometry, material);
      line.paint = () => material.color.set(colour());
      line.frustumCulled = false;
      line.paint();
      lines.push(line);
      return line;
    };
    view.ball = function (radius, colour) {
      const material = new THREE.MeshBasicMaterial();
      const ball = new THREE.Mesh(new THREE.SphereGeometry(radius, 20, 14), material);
      ball.paint = () => material.color.set(colour());
      ball.paint();
      lines.push(ball);
      return ball;
    };
    view.arrowhead = function (along, tip, colour) {   // a cone along a unit vector
      const way = new THREE.Vector3(...along), middle = new THREE.Vector3(...tip), corners = [];
      const side = new THREE.Vector3(Math.abs(along[0]) < 0.8 ? 1 : 0, Math.abs(along[0]) < 0.8 ? 0 : 1, 0).cross(way).normalize();
      const other = way.clone().cross(side), end = middle.clone().addScaledVector(way, 0.16);
      const rim = (k) => middle.clone().addScaledVector(side, 0.055 * Math.cos(k * Math.PI / 10)).addScaledVector(other, 0.055 * Math.sin(k * Math.PI / 10));
      for (let k = 0; k < 20; k++) for (const top of [end, middle]) {
        for (const point of [top, rim(k), rim(k + 1)]) corners.push(...point.toArray());
      }
      const made = new THREE.BufferGeometry();
      made.setAttribute("position", new THREE.BufferAttribute(new Float32Array(corners), 3));
      const material = new THREE.MeshBasicMaterial({ side: 2 });
      const head = new THREE.Mesh(made, material);
      head.paint = () => material.color.set(colour());
      head.paint();
      lines.push(head);
      return head;
    };
    view.draw = function () {
      const width = canvas.clientWidth, height = canvas.clientHeight;
      if (!width || !height) return;
      const ratio = Math.min(2, window.devicePixelRatio || 1);
      if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
        renderer.setPixelRatio(ratio);
        renderer.setSize(width, height, false);
        camera.aspect = width / height;
        camera.updateProjectionMatrix();
      }
      const away = reach / Math.min(1, camera.aspect) / Math.tan((15 * Math.PI) / 180);
      camera.position.set(Math.cos(elevation) * Math.cos(azimuth), Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation));
      light.position.copy(camera.position).add(new THREE.Vector3(0.2, 0.3, 0.9));
      camera.position.multiplyScalar(away);
      camera.lookAt(0, 0, 0);
      renderer.render(scene, camera);
    };
    const turn = (right, up) => {
      azimuth -= right;
      elevation = Math.max(-1.5, Math.min(1.5, elevation + up));
      view.draw();
    };
    let held = null;
    canvas.addEventListener("pointerdown", (event) => {
      held = [event.clientX, event.clientY];
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!held) return;
      turn((event.clientX - held[0]) / 120, (event.clientY - held[1]) / 120);
      held = [event.clientX, event.clientY];
    });
    canvas.addEventListener("pointerup", () => (held = null));
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      reach = Math.max(0.3, Math.min(6, reach * Math.exp(event.deltaY / 800)));
      view.draw();
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[event.key];
      if (step) { event.preventDefault(); turn(...step); }
    });
    return view;
  }

  function geometry(corners, normals, colours) {
    const made = new THREE.BufferGeometry();
    made.setAttribute("position", new THREE.BufferAttribute(corners, 3));
    made.setAttribute("normal", new THREE.BufferAttribute(normals, 3));
    if (colours) {   // given as on a screen, wanted as light
      const colour = new THREE.Color();
      for (let k = 0; k < colours.length; k += 3) {
        colour.setRGB(colours[k], colours[k + 1], colours[k + 2], "srgb").toArray(colours, k);
      }
      made.setAttribute("color", new THREE.BufferAttribute(colours, 3));
    }
    return made;
  }

  // The frames' positions of a tip, and how much of its line is drawn at a time.
  function trail(view, points, colour, width) {
    view.scene.add(view.line(points, colour, 1, 0.3));
    const line = view.line(points, colour, width);
    view.scene.add(line);
    const ball = view.ball(0.035, colour);
    view.scene.add(ball);
    return function (at) {
      const k = Math.min(film.count - 2, Math.floor(at)), s = at - k;
      line.geometry.instanceCount = Math.max(0, k);
      line.visible = k > 0;
      ball.position.set(...[0, 1, 2].map((j) => points[3 * k + j] * (1 - s) + points[3 * k + 3 + j] * s));
      return ball.position;
    };
  }

  let views, show;
  function build() {
    const space = makeView(find("body"), -0.9, 0.35, 1.35);
    views = [space];
    const body = new THREE.Group();
    const material = new THREE.MeshLambertMaterial({ vertexColors: true, side: 2 });
    const solid = film.solid;
    body.add(new THREE.Mesh(geometry(unpack(solid.corners), unpack(solid.normals), unpack(solid.colours)), material));
    const axis = new THREE.Vector3(...film.axis), reach = 1.15;
    const rod = [...axis.clone().multiplyScalar(film.arm ? 0 : -reach).toArray(), ...axis.clone().multiplyScalar(reach).toArray()];
    body.add(space.line(rod, ink, 1.5));
    space.scene.add(body);
    if (film.arm) space.scene.add(space.ball(0.03, ink));
    if (film.momentum) {
      const tip = film.momentum.map((x) => 1.3 * x);
      space.scene.add(space.line([0, 0, 0, ...tip], ink, 2.5), space.arrowhead(film.momentum, tip, ink));
    }
    const frame = new THREE.Quaternion(), next = new THREE.Quaternion();
    const points = new Float32Array(3 * film.count), tip = new THREE.Vector3();
    for (let k = 0; k < film.count; k++) {
      tip.copy(axis).multiplyScalar(reach).applyQuaternion(frame.fromArray(attitude, 4 * k)).toArray(points, 3 * k);
    }
    const follow = trail(space, points, () => hue(film.path), 2.2);

    let tipOfOmega = () => undefined;
    if (film.poinsot.semi) {
      const poinsot = makeView(find("poinsot").querySelector("canvas"), 0.61, 0.38, 1.15);
      views.push(poinsot);
      const grey = new THREE.MeshLambertMaterial({ polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2 });
      grey.paint = () => grey.color.set(isDark() ? "#3a424b" : "#dfe5ea");
      grey.paint();
      poinsot.lines.push(grey);
      const ellipsoid = new THREE.Mesh(new THREE.SphereGeometry(1, 72, 48), grey);
      ellipsoid.scale.set(...film.poinsot.semi);
      poinsot.scene.add(ellipsoid);
      film.poinsot.lines.forEach((one) => poinsot.scene.add(
        poinsot.line(lifted(unpack(one.points)), ink, one.strong ? 1.6 : 0.8, one.strong ? 0.9 : 0.55)));
      film.poinsot.semi.forEach((semi, k) => {
        const end = [0, 0, 0];
        end[k] = 1.18 * semi;
        poinsot.scene.add(poinsot.line([0, 0, 0, ...end], () => film.sides[k], 2.5));
      });
      const ellipse = trail(poinsot, lifted(unpack(film.poinsot.path)), () => hue(film.accent), 3);
      tipOfOmega = ellipse;
    } else {
      find("poinsot").hidden = true;
    }
    show = function (t) {
      const at = ((t - film.begin) / (film.end - film.begin)) * (film.count - 1);
      const k = Math.max(0, Math.min(film.count - 2, Math.floor(at)));
      frame.fromArray(attitude, 4 * k);
      next.fromArray(attitude, 4 * k + 4);
      body.quaternion.copy(frame).slerp(next, at - k);
      follow(at);
      tipOfOmega(at);
      views.forEach((view) => view.draw());
    };
  }
  const lifted = (points) => points.map((x) => 1.004 * x);   // above the surface, so that it does not cover them

  let now = film.begin, playing = false, last = 0;
  const slider = find("time"), play = find("play"), clock = find("clock");
  slider.min = film.begin;
  slider.max = film.end;
  const digits = Math.max(0, 3 - Math.ceil(Math.log10(film.end - film.begin)));

  function go(t) {
    now = Math.min(film.end, Math.max(film.begin, t));
    slider.value = now;
    clock.textContent = `${now.toFixed(digits)} s`;
    show(now);
  }
  function run(on) {
    playing = on;
    play.textContent = on ? "❚❚" : "▶";
    if (on) {
      if (now >= film.end) now = film.begin;
      last = performance.now();
      requestAnimationFrame(tick);
    }
  }
  function tick(stamp) {
    if (!playing) return;
    const pace = ((film.end - film.begin) / film.seconds) * Number(find("pace").value);
    go(now + (Math.max(0, stamp - last) / 1000) * pace);
    last = stamp;
    if (now >= film.end) now = film.begin;   // again from the start
    requestAnimationFrame(tick);
  }

  try {
    build();
    go(film.begin);
  } catch (error) {
    find("trouble").textContent = `The body cannot be drawn: ${error.message}. This page needs WebGL.`;
    find("trouble").hidden = false;
    document.body.dataset.drawn = "no";
    return;
  }
  slider.addEventListener("input", () => { run(false); go(Number(slider.value)); });
  play.addEventListener("click", () => run(!playing));
  document.addEventListener("keydown", (event) => {
    if (event.key === " " && event.target.tagName !== "BUTTON") { event.preventDefault(); run(!playing); }
  });
  window.addEventListener("resize", () => go(now));
  function repaint() {
    views.forEach((view) => view.lines.forEach((one) => one.paint()));
    go(now);
  }
  system.addEventListener("change", repaint);
  window.addEventListener("hashchange", () => { dress(); repaint(); });
  const asked = /[#&]t=([-\d.eE+]+)/.exec(location.hash);
  const begin = asked ? Number(asked[1]) : film.start;
  go(begin === null ? film.begin : begin);
  if (begin === null && !window.matchMedia("(prefers-reduced-motion: reduce)").matches) run(true);
  window.polhode = { go, run };
  document.body.dataset.drawn = "yes";
})();
