// SPDX-License-Identifier: Apache-2.0
// The moment that is shown, playing, keys: the end of the function that base.js begins.
  // ---- The moment that everything shows: null before one is chosen.
  let now = null;
  let passing = null;

  function explainShades() {
    plan.values.textContent = '';
    let held = 0, loading = 0;
    shaded.forEach(function (state) { if (state === 2) ++held; else ++loading; });
    [['held', held + ' in memory'], ['loading', loading + ' being loaded'], ['empty', 'not in memory'],
      ['own', "the robot's zone"]].forEach(function (entry) {
      const item = make('span');
      item.appendChild(make('span', {class: 'swatch ' + entry[0]}));
      item.appendChild(document.createTextNode(entry[1]));
      plan.values.appendChild(item);
    });
  }

  function set(t) {
    now = t === null ? null : clamp(t, 0, duration);
    body.classList.toggle('moving', now !== null);
    place(0, now);
    moveRobots(now);
    shade(now);
    if (dots) fadeDots(now);
    if (plan) {
      if (now === null) nameZone(chosen); else explainShades();
    }
    if (passing === null) showValues(now);
    const zone = now === null ? -1 : zoneAt(now);
    const text = now === null ? 'press play' : secondsText(now) + (zone >= 0 ? ' · ' + zoneNames[zone] : '');
    output.textContent = text;
    slider.value = now === null ? 0 : now;
    slider.setAttribute('aria-valuetext', text);
    if (times.length) follow();
  }

  function pass(t) {
    passing = t;
    place(1, t);
    showValues(t === null ? now : t);
  }

  // The address names the moment, so that it can be sent to somebody.
  function remember() {
    const fragment = now === null ? '#' : '#t=' + +(now / 1000).toFixed(3);
    try { history.replaceState(null, '', fragment); } catch (error) { /* not where the page may not */ }
  }

  function readAddress() {
    const match = /^#t=(\d+(?:\.\d+)?)$/.exec(location.hash);
    if (match) { stop(); set(Number(match[1]) * 1000); }
    return Boolean(match);
  }

  // ---- Playing.
  let frame = 0;
  function stop() {
    if (!frame) return;
    cancelAnimationFrame(frame);
    frame = 0;
    play.textContent = '▶ Play';
    play.setAttribute('aria-label', 'Play the run');
    remember();
  }

  function start() {
    if (now === null || now >= duration) set(0);
    let before = null;
    play.textContent = '⏸ Pause';
    play.setAttribute('aria-label', 'Pause');
    const step = function (stamp) {
      frame = requestAnimationFrame(step);
      if (before !== null) set(now + Math.min(stamp - before, 100) * Number(speed.value));
      before = stamp;
      if (now >= duration) stop();
    };
    frame = requestAnimationFrame(step);
  }

  play.addEventListener('click', function () { if (frame) stop(); else start(); });
  slider.addEventListener('input', function () { stop(); set(Number(slider.value)); });
  slider.addEventListener('change', remember);
  document.addEventListener('keydown', function (event) {
    const target = event.target;
    if (event.ctrlKey || event.altKey || event.metaKey || target.closest('select, .table, .list')) return;
    const step = {ArrowLeft: -1, ArrowRight: 1}[event.key];
    if (step !== undefined) {  // a second, ten with shift: also on the slider, whose own steps differ with the run
      event.preventDefault();
      stop();
      set((now === null ? 0 : now) + step * (event.shiftKey ? 10000 : 1000));
      remember();
    } else if (event.key === ' ' && !target.closest('button, input')) {
      event.preventDefault();
      play.click();
    } else if (event.key === 'Escape' && now !== null) {
      stop();
      set(null);
      remember();
    }
  });
  window.addEventListener('hashchange', readAddress);
  window.addEventListener('resize', function () { if (times.length) renderRows(); });
  let atPrint = null;  // paper shows the whole run
  window.addEventListener('beforeprint', function () { atPrint = now; set(null); });
  window.addEventListener('afterprint', function () { set(atPrint); });

  body.classList.add('playable');
  buildList();
  if (plan) plan.svgs.forEach(addRobot);
  if (dots) {
    dots.svgs.forEach(addRobot);
    dots.drawings.forEach(function (drawing) {
      drawing.svg.addEventListener('click', function (event) {
        const dot = drawing.nearest(event);
        if (!dot) return;
        stop();
        set(dot.t);
        nameDot(drawing, dot);
        remember();
      });
    });
  }
  if (times.length) fillRows();
  if (!readAddress()) set(null);
})();
