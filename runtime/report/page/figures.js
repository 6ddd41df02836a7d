// SPDX-License-Identifier: Apache-2.0
// The figures of a page, and what is named on a press: part of the function that base.js begins.
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
