// SPDX-License-Identifier: Apache-2.0
// What a report's page does beyond showing itself: values under a cursor that all charts share, the run played on the
// plan, the list of events, tables in another order, a light or dark page. Text enters the page as text only. Times are
// milliseconds since the start of the run. The address's fragment is a moment in seconds: report.html#t=12.5
(function () {
  'use strict';

  const data = JSON.parse(document.getElementById('data').textContent);
  const root = document.documentElement;
  const body = document.body;
  const main = document.querySelector('main');

  // ---- Small helpers.
  function make(name, attributes, text) {
    const element = document.createElement(name);
    for (const key of Object.keys(attributes || {})) element.setAttribute(key, attributes[key]);
    if (text !== undefined) element.textContent = text;
    return element;
  }

  function drawn(name, attributes) {
    const element = document.createElementNS('http://www.w3.org/2000/svg', name);
    for (const key of Object.keys(attributes || {})) element.setAttribute(key, attributes[key]);
    return element;
  }

  function clamp(value, low, high) { return Math.min(Math.max(value, low), high); }

  // Undoes script_differences(): null becomes NaN and passes no difference on.
  function summed(differences, per) {
    const values = new Float64Array(differences.length);
    let sum = 0;
    for (let i = 0; i < differences.length; ++i) {
      if (differences[i] === null) {
        values[i] = NaN;
      } else {
        sum += differences[i];
        values[i] = sum / per;
      }
    }
    return values;
  }

  // The last index whose time is not after t; -1 before the first.
  function indexAt(times, t) {
    let low = 0, high = times.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (times[middle] <= t) low = middle + 1; else high = middle;
    }
    return low - 1;
  }

  function bytesText(bytes) {
    const units = ['B', 'KiB', 'MiB', 'GiB', 'TiB'];
    let unit = 0;
    while (Math.abs(bytes) >= 1024 && unit + 1 < units.length) { bytes /= 1024; ++unit; }
    const size = Math.abs(bytes);
    return +bytes.toFixed(unit === 0 || size >= 100 ? 0 : size >= 10 ? 1 : 2) + ' ' + units[unit];
  }

  function secondsText(t) { return (t / 1000).toFixed(1) + ' s'; }

  // ---- Light or dark: the reader's system decides until the button is pressed.
  (function () {
    const system = window.matchMedia('(prefers-color-scheme: dark)');
    const button = make('button', {type: 'button', class: 'theme'});
    function stored(value) {  // a page opened from a file may have no storage
      try {
        if (value) localStorage.setItem('zonepack-theme', value);
        return localStorage.getItem('zonepack-theme');
      } catch (error) { return null; }
    }
    function isDark() { return root.dataset.theme ? root.dataset.theme === 'dark' : system.matches; }
    function label() { button.textContent = isDark() ? '☀ Light' : '☾ Dark'; }
    const before = stored();
    if (before === 'dark' || before === 'light') root.dataset.theme = before;
    button.addEventListener('click', function () {
      root.dataset.theme = isDark() ? 'light' : 'dark';
      stored(root.dataset.theme);
      label();
    });
    if (system.addEventListener) system.addEventListener('change', label);
    label();
    main.insertBefore(button, main.firstChild);
  })();

  // ---- Tables: a press on a heading sorts by that column.
  function sortKey(text) {
    const factors = {KiB: 1024, MiB: 1048576, GiB: 1073741824};
    const match = /^(-?[\d.]+) ?([KMG]iB)?/.exec(text.replace(/[\s\u2009](?=\d)/g, ''));
    return match ? parseFloat(match[1]) * (factors[match[2]] || 1) : -Infinity;
  }

  function sortable(table) {
    const heads = Array.from(table.tHead.rows[0].cells);
    heads.forEach(function (head, column) {
      const number = head.classList.contains('n');
      const button = make('button', {type: 'button', title: 'sort by ' + head.textContent}, head.textContent);
      head.textContent = '';
      head.appendChild(button);
      button.addEventListener('click', function () {
        const down = head.getAttribute('aria-sort') === (number ? 'none' : 'ascending') || (number && !head.hasAttribute('aria-sort'));
        heads.forEach(function (other) { other.removeAttribute('aria-sort'); });
        head.setAttribute('aria-sort', down ? 'descending' : 'ascending');
        const rows = Array.from(table.tBodies[0].rows).map(function (row) {
          const text = row.cells[column].textContent;
          return {row: row, key: number ? sortKey(text) : text};
        });
        rows.sort(function (a, b) {
          const order = number ? a.key - b.key : a.key.localeCompare(b.key, 'en', {numeric: true});
          return down ? -order : order;
        });
        rows.forEach(function (entry) { table.tBodies[0].appendChild(entry.row); });
      });
    });
  }
  const boxes = Array.from(document.querySelectorAll('.table'));
  boxes.forEach(function (box) {
    sortable(box.querySelector('table'));
    if (box.scrollWidth > box.clientWidth) box.tabIndex = 0;  // keys can scroll it
  });

  // ---- The figures, as the page has them.
  const figures = Array.from(document.querySelectorAll('figure'));
  const charts = [];
  let plan = null;
  let dots = null;  // the plan whose dots are places found at moments

  function numbers(text) { return text.split(' ').map(Number); }

  figures.forEach(function (figure, i) {
    const about = data.figures[i];
    if (!about) return;
    const values = make('p', {class: 'values'});
    figure.insertBefore(values, figure.querySelector('.drawing'));
    const svgs = Array.from(figure.querySelectorAll('.drawing > svg'));
    if (about.kind === 'plan' && !plan) {
      plan = {figure: figure, values: values, svgs: svgs, zones: about.zones};
    } else if (about.kind === 'dots') {
      dots = {figure: figure, values: values, svgs: svgs, drawings: []};
    } else if (about.kind === 'chart') {
      charts.push({figure: figure, values: values, svgs: svgs, bytes: about.bytes, unit: about.unit,
        series: about.series.map(function (series) {
          return {name: series.name, color: series.color, steps: series.steps, t: summed(series.t, 1),
            v: summed(series.v, series.per)};
        })});
    }
  });

  // ---- The plan: a press on a zone or on its row says what it is.
  const ground = [];  // by zone: its shapes on every drawing
  const borders = {own: [], chosen: []};  // drawn above the zones, whose own borders lie below their neighbours'
  function takePlan(svg) {
    svg.addEventListener('click', function (event) {
      const shape = event.target.closest('[data-zone]');
      if (shape) choose(Number(shape.dataset.zone));
    });
    svg.addEventListener('pointerover', function (event) {
      const shape = event.target.closest('[data-zone]');
      nameZone(shape ? Number(shape.dataset.zone) : chosen);
    });
    svg.querySelectorAll('[data-zone]').forEach(function (shape) {
      const zone = Number(shape.dataset.zone);
      (ground[zone] = ground[zone] || []).push(shape);
    });
    const shapes = svg.querySelectorAll('[data-zone]');
    Object.keys(borders).forEach(function (kind) {
      const border = drawn('path', {class: 'border ' + kind, 'fill-rule': 'evenodd'});
      if (shapes.length) shapes[0].parentNode.insertBefore(border, shapes[shapes.length - 1].nextSibling);
      borders[kind].push({path: border, shapes: shapes});
    });
  }

  function surround(kind, zone) {
    borders[kind].forEach(function (border) {
      const shape = Array.from(border.shapes).find(function (s) { return Number(s.dataset.zone) === zone; });
      if (shape) border.path.setAttribute('d', shape.getAttribute('d')); else border.path.removeAttribute('d');
    });
  }

  const rowOf = new Map();
  let chosen = -1;
  function choose(zone) {
    if (rowOf.has(chosen)) rowOf.get(chosen).classList.remove('chosen');
    chosen = zone === chosen ? -1 : zone;
    surround('chosen', chosen);
    if (rowOf.has(chosen)) rowOf.get(chosen).classList.add('chosen');
    nameZone(chosen);
  }

  function nameZone(zone) {
    if (body.classList.contains('moving')) return;  // the line then explains the shades
    const shape = (ground[zone] || [])[0];
    const title = shape && shape.querySelector('title');
    plan.values.textContent = title ? title.textContent : 'Point at a zone to see what it holds.';
  }

  if (plan) {
    plan.svgs.forEach(takePlan);
    const byName = new Map(plan.zones.map(function (name, zone) { return [name, zone]; }));
    boxes.forEach(function (box) {
      Array.from(box.querySelectorAll('tbody tr')).forEach(function (row) {
        const zone = row.cells.length ? byName.get(row.cells[0].textContent) : undefined;
        if (zone === undefined || !ground[zone]) return;
        rowOf.set(zone, row);
        row.classList.add('pick');
        row.addEventListener('click', function () { choose(zone); });
      });
    });
    nameZone(-1);
  }

  // ---- Dots: the one that is nearest to the pointer, or to a finger, is named.
  function takeDots(svg) {
    const drawing = {svg: svg, dots: Array.from(svg.querySelectorAll('[data-t]')).map(function (shape) {
      return {shape: shape, x: Number(shape.getAttribute('cx')), y: Number(shape.getAttribute('cy')),
        t: Number(shape.dataset.t)};
    })};
    drawing.ring = drawn('circle', {class: 'pointed', r: 8, visibility: 'hidden'});
    svg.appendChild(drawing.ring);
    drawing.nearest = function (event) {
      const box = svg.getBoundingClientRect();
      const scale = svg.viewBox.baseVal.width / box.width;
      const x = (event.clientX - box.left) * scale, y = (event.clientY - box.top) * scale;
      let best = null, least = 20 * scale;
      drawing.dots.forEach(function (dot) {
        const apart = Math.hypot(dot.x - x, dot.y - y);
        if (apart < least) { best = dot; least = apart; }
      });
      return best;
    };
    svg.addEventListener('pointermove', function (event) { nameDot(drawing, drawing.nearest(event)); });
    svg.addEventListener('pointerleave', function (event) {
      if (event.pointerType === 'mouse') nameDot(drawing, null);
    });
    dots.drawings.push(drawing);
  }

  function nameDot(drawing, dot) {
    const title = dot && dot.shape.querySelector('title');
    dots.values.textContent = title ? title.textContent : 'Point at a dot to see what it is' +
      (data.playback ? '; a press goes to its moment.' : '.');
    drawing.ring.setAttribute('visibility', dot ? 'visible' : 'hidden');
    if (!dot) return;
    drawing.ring.setAttribute('cx', dot.x);
    drawing.ring.setAttribute('cy', dot.y);
  }

  if (dots) {
    dots.svgs.forEach(takeDots);
    nameDot(dots.drawings[0], null);
  }

  if (!data.playback) return;
  const run = data.playback;
  const duration = Math.max(run.duration, 1);

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

  // ---- The robot on the plan.
  const robots = [];
  function addRobot(svg) {
    const small = svg.viewBox.baseVal.width < 500;
    const group = drawn('g', {class: 'robot', visibility: 'hidden'});
    const size = small ? 0.75 : 1;
    group.appendChild(drawn('circle', {r: 18 * size}));
    group.appendChild(drawn('path', {d: 'M12 0L-8 8L-4 0L-8 -8Z', transform: 'scale(' + size + ')'}));
    svg.appendChild(group);
    robots.push({group: group, at: numbers(svg.dataset.plan)});
  }

  function moveRobots(t) {
    const pose = t === null ? null : poseAt(t);
    robots.forEach(function (robot) {
      robot.group.setAttribute('visibility', pose ? 'visible' : 'hidden');
      if (!pose) return;
      const m = robot.at;
      const x = m[0] * pose.x + m[2] * pose.y + m[4], y = m[1] * pose.x + m[3] * pose.y + m[5];
      const c = Math.cos(pose.a), s = Math.sin(pose.a);
      const angle = Math.atan2(m[1] * c + m[3] * s, m[0] * c + m[2] * s) * 180 / Math.PI;
      robot.group.setAttribute('transform',
        'translate(' + x.toFixed(2) + ' ' + y.toFixed(2) + ') rotate(' + angle.toFixed(1) + ')');
    });
  }

  let shaded = new Map();  // zone: 1 or 2, as heldAt() says
  let own = -1;
  function shade(t) {
    const names = ['', 'loading', 'held'];
    const next = t === null ? new Map() : heldAt(t);
    shaded.forEach(function (state, zone) {
      if (next.get(zone) !== state) (ground[zone] || []).forEach(function (s) { s.classList.remove(names[state]); });
    });
    next.forEach(function (state, zone) {
      if (shaded.get(zone) !== state) (ground[zone] || []).forEach(function (s) { s.classList.add(names[state]); });
    });
    shaded = next;
    const zone = t === null ? -1 : zoneAt(t);
    if (zone !== own) surround('own', zone);
    own = zone;
  }

  // Dots of moments that are still to come are faint.
  function fadeDots(t) {
    dots.drawings.forEach(function (drawing) {
      drawing.dots.forEach(function (dot) { dot.shape.classList.toggle('future', t !== null && dot.t > t + 0.5); });
    });
  }

  // ---- The bar with the time.
  const bar = make('div', {class: 'bar', role: 'group', 'aria-label': 'Time of the run'});
  const play = make('button', {type: 'button', 'aria-label': 'Play the run', title: 'Play the run (space)'}, '▶ Play');
  const slider = make('input', {type: 'range', min: 0, max: duration, step: Math.max(1, Math.round(duration / 2000)),
    value: 0, 'aria-label': 'Moment of the run'});
  const output = make('output', {}, 'not set');
  const speed = make('select', {'aria-label': 'Speed'});
  [1, 2, 5, 10, 30, 60, 300, 1800].forEach(function (factor) { speed.appendChild(make('option', {value: factor}, factor + '×')); });
  speed.value = String([1, 2, 5, 10, 30, 60, 300, 1800].find(function (f) { return duration / f <= 40000; }) || 1800);
  [play, slider, output, speed].forEach(function (part) { bar.appendChild(part); });
  body.appendChild(bar);

  // ---- The list of events: only the rows in view are in the page.
  const times = summed(run.events.t, 1);
  const kRow = 26;
  const aside = make('aside', {'aria-label': 'Plan and events'});
  const list = make('div', {class: 'list', role: 'listbox', tabindex: 0, 'aria-label': 'Events'});
  const kindChoice = make('select', {'aria-label': 'Kind of event'});
  let rows = [];  // indices of the events that the filter lets through
  let current = -1;

  function buildList() {
    if (plan && plan.svgs.length) {
      const copy = plan.svgs[plan.svgs.length - 1].cloneNode(true);
      const small = make('div', {class: 'small', role: 'img', 'aria-label': 'The plan again, small'});
      small.appendChild(copy);
      aside.appendChild(small);
      takePlan(copy);
      addRobot(copy);
    }
    if (times.length) {
      const count = run.events.kinds.map(function () { return 0; });
      run.events.k.forEach(function (kind) { ++count[kind]; });
      kindChoice.appendChild(make('option', {value: '-1'}, 'all kinds (' + times.length + ')'));
      run.events.kinds.map(function (name, kind) { return [name, kind]; }).sort().forEach(function (entry) {
        kindChoice.appendChild(make('option', {value: entry[1]}, entry[0] + ' (' + count[entry[1]] + ')'));
      });
      const filter = make('div', {class: 'filter'});
      filter.appendChild(kindChoice);
      aside.appendChild(make('h2', {}, 'Events'));
      aside.appendChild(filter);
      aside.appendChild(list);
      kindChoice.addEventListener('change', fillRows);
      list.addEventListener('scroll', renderRows);
      list.addEventListener('click', function (event) {
        const row = event.target.closest('[role="option"]');
        if (row) jump(Number(row.dataset.row));
      });
      list.addEventListener('keydown', function (event) {
        const step = {ArrowDown: 1, ArrowUp: -1, PageDown: 10, PageUp: -10, Home: -rows.length, End: rows.length}[event.key];
        if (step === undefined || !rows.length) return;
        event.preventDefault();
        event.stopPropagation();
        jump(clamp(current + step, 0, rows.length - 1));
      });
    }
    if (aside.firstChild) body.insertBefore(aside, bar);
  }

  function jump(row) {
    stop();
    set(times[rows[row]]);
    current = row;  // of several at one moment, the one that was pressed
    renderRows();
    remember();
  }

  function fillRows() {
    const kind = Number(kindChoice.value);
    rows = [];
    for (let i = 0; i < times.length; ++i) {
      if (kind < 0 || run.events.k[i] === kind) rows.push(i);
    }
    follow();
  }

  // Scrolls the list, and never the page, to the last event before the cursor.
  function follow() {
    let low = 0, high = rows.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (now !== null && times[rows[middle]] <= now + 0.5) low = middle + 1; else high = middle;
    }
    current = low - 1;
    const y = current * kRow;
    if (current >= 0 && (y < list.scrollTop || y + 2 * kRow > list.scrollTop + list.clientHeight)) {
      list.scrollTop = y - list.clientHeight / 3;
    }
    renderRows();
  }

  function renderRows() {
    const first = Math.max(0, Math.floor(list.scrollTop / kRow) - 4);
    const last = Math.min(rows.length, first + Math.ceil((list.clientHeight || 300) / kRow) + 8);
    list.textContent = '';
    const whole = make('div', {'aria-hidden': 'true'});
    whole.style.height = rows.length * kRow + 'px';
    list.appendChild(whole);
    for (let i = first; i < last; ++i) {
      const event = rows[i];
      const row = make('div', {role: 'option', id: 'event' + i, 'data-row': i, 'aria-selected': i === current,
        'aria-posinset': i + 1, 'aria-setsize': rows.length});
      row.style.top = i * kRow + 'px';
      if (now !== null && times[event] > now + 0.5) row.className = 'future';
      row.appendChild(make('time', {}, secondsText(times[event])));
      row.appendChild(make('span', {class: 'kind'}, run.events.kinds[run.events.k[event]]));
      const zone = run.events.z[event];
      if (zone >= 0) row.appendChild(make('span', {class: 'zone'}, zoneNames[zone]));
      list.appendChild(row);
    }
    if (current >= first && current < last) list.setAttribute('aria-activedescendant', 'event' + current);
    else list.removeAttribute('aria-activedescendant');
  }

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
