// SPDX-License-Identifier: Apache-2.0
// The values at a time, under a cursor that all charts share: part of the function that base.js begins.
  // ---- What is known at a time.
  const track = {t: summed(run.track.t, 1), x: summed(run.track.x, 1000), y: summed(run.track.y, 1000),
    a: summed(run.track.a, 100)};
  const zoneNames = plan ? plan.zones : [];
  const stayFrom = new Float64Array(run.stays.length / 3);
  for (let i = 0; i < stayFrom.length; ++i) stayFrom[i] = run.stays[3 * i + 1];

  function poseAt(t) {
    const i = indexAt(track.t, t);
    if (i < 0 || isNaN(track.x[i])) return null;
    const next = i + 1 < track.t.length && !isNaN(track.x[i + 1]) ? i + 1 : i;
    const share = next > i ? (t - track.t[i]) / (track.t[next] - track.t[i]) : 0;
    const between = function (values) { return values[i] + (values[next] - values[i]) * share; };
    return {x: between(track.x), y: between(track.y), a: between(track.a)};
  }

  function zoneAt(t) {
    const i = indexAt(stayFrom, t);
    return i >= 0 && t < stayFrom[i] + run.stays[3 * i + 2] + 1 ? run.stays[3 * i] : -1;
  }

  // 1: being loaded, 2: in memory; zones that are neither are absent.
  function heldAt(t) {
    const held = new Map();
    for (let i = 0; i < run.holds.length; i += 4) {
      const from = run.holds[i + 1];
      if (from > t) break;
      if (t >= from + run.holds[i + 3] && from + run.holds[i + 3] < duration) continue;
      held.set(run.holds[i], t < from + run.holds[i + 2] ? 1 : 2);
    }
    return held;
  }

  function valueAt(series, t) {
    const i = indexAt(series.t, t);
    if (i < 0) return NaN;
    if (series.steps || i + 1 >= series.t.length || isNaN(series.v[i + 1])) return series.v[i];
    const share = (t - series.t[i]) / (series.t[i + 1] - series.t[i]);
    return series.v[i] + (series.v[i + 1] - series.v[i]) * share;
  }

  function valueText(chart, value) {
    if (isNaN(value)) return '–';
    if (chart.bytes) return bytesText(value);
    return (chart.unit ? +value.toFixed(3) : Math.round(value)) + chart.unit;
  }

  // ---- Cursors on the charts.
  charts.forEach(function (chart) {
    chart.figure.classList.add('timed');
    chart.drawings = chart.svgs.map(function (svg) {
      const plot = numbers(svg.dataset.plot);
      const drawing = {svg: svg, left: plot[0], top: plot[1], width: plot[2], height: plot[3], duration: plot[4] * 1000,
        most: plot[5]};
      drawing.cursors = ['', ' passing'].map(function (css) {
        const group = drawn('g', {class: 'cursor' + css, visibility: 'hidden'});
        group.appendChild(drawn('line', {y1: drawing.top, y2: drawing.top + drawing.height}));
        const dots = chart.series.map(function (series) {
          const dot = drawn('circle', {r: 4, fill: series.color});
          group.appendChild(dot);
          return dot;
        });
        svg.appendChild(group);
        return {group: group, line: group.firstChild, dots: dots};
      });
      listen(drawing);
      return drawing;
    });
    chart.time = make('b');
    chart.values.appendChild(chart.time);
    chart.numbers = chart.series.map(function (series) {
      const item = make('span');
      const swatch = make('span', {class: 'swatch'});
      swatch.style.background = 'var(--c' + series.color.slice(1) + ')';
      item.appendChild(swatch);
      item.appendChild(document.createTextNode(series.name + ' '));
      const number = make('b');
      item.appendChild(number);
      chart.values.appendChild(item);
      return number;
    });
  });

  function timeOf(drawing, event) {
    const box = drawing.svg.getBoundingClientRect();
    const x = (event.clientX - box.left) / box.width * drawing.svg.viewBox.baseVal.width;
    return clamp((x - drawing.left) / drawing.width * drawing.duration, 0, duration);
  }

  function listen(drawing) {
    let dragging = false;
    drawing.svg.addEventListener('pointerdown', function (event) {
      if (event.button !== 0) return;
      dragging = true;
      if (drawing.svg.setPointerCapture) drawing.svg.setPointerCapture(event.pointerId);
      stop();
      set(timeOf(drawing, event));
    });
    drawing.svg.addEventListener('pointermove', function (event) {
      if (dragging) set(timeOf(drawing, event)); else pass(timeOf(drawing, event));
    });
    ['pointerup', 'pointercancel'].forEach(function (name) {
      drawing.svg.addEventListener(name, function () {
        if (dragging) remember();
        dragging = false;
      });
    });
    drawing.svg.addEventListener('pointerleave', function () { pass(null); });
  }

  function place(which, t) {
    charts.forEach(function (chart) {
      chart.drawings.forEach(function (drawing) {
        const cursor = drawing.cursors[which];
        cursor.group.setAttribute('visibility', t === null ? 'hidden' : 'visible');
        if (t === null) return;
        const x = drawing.left + t / drawing.duration * drawing.width;
        cursor.line.setAttribute('x1', x);
        cursor.line.setAttribute('x2', x);
        chart.series.forEach(function (series, i) {
          const value = valueAt(series, t);
          cursor.dots[i].setAttribute('visibility', isNaN(value) ? 'hidden' : 'inherit');
          if (isNaN(value)) return;
          cursor.dots[i].setAttribute('cx', x);
          cursor.dots[i].setAttribute('cy', drawing.top + drawing.height * (1 - clamp(value / drawing.most, 0, 1)));
        });
      });
    });
  }

  function showValues(t) {
    charts.forEach(function (chart) {
      const zone = t === null ? -1 : zoneAt(t);
      chart.time.textContent = t === null ? 'at the end' : secondsText(t) + (zone >= 0 ? ' in ' + zoneNames[zone] : '');
      chart.series.forEach(function (series, i) {
        chart.numbers[i].textContent = valueText(chart, valueAt(series, t === null ? duration : t));
      });
    });
  }
