// SPDX-License-Identifier: Apache-2.0
// The bar with the time, and the list of events: part of the function that base.js begins.
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
