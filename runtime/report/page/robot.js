// SPDX-License-Identifier: Apache-2.0
// The robot and the zones in memory on the plan: part of the function that base.js begins.
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
