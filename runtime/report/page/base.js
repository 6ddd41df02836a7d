// SPDX-License-Identifier: Apache-2.0
// What a report's page does beyond showing itself: values under a cursor that all charts share, the run played on the
// plan, the list of events, tables in another order, a light or dark page. Text enters the page as text only. Times are
// milliseconds since the start of the run. The address's fragment is a moment in seconds: report.html#t=12.5
// One function in several files, joined in the order base, figures, cursor, robot, events, moment.
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
