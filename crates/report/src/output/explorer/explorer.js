// The fields of a study on a canvas: choose model, field and step, point at a place, drag over the curve.
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("explorer-data").textContent);
  const element = (name) => document.getElementById("explorer-" + name);
  const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const words = (text, Type) => new Type(bytes(text).buffer);
  // Values are 16-bit shares of their range; the largest share stands for what is no number.
  const values = ([low, high, text]) =>
    Float64Array.from(words(text, Uint16Array), (n) => (n === 65535 ? NaN : low + ((high - low) * n) / 65534));
  const tables = { even: bytes(data.colours.even), signed: bytes(data.colours.signed) };
  const cache = new Map();
  const field = (model, name, step) => {
    const key = [model.name, name, step].join("|");
    const stored = model.steps[step] && model.steps[step][name];
    if (stored && !cache.has(key)) cache.set(key, values(stored));
    return cache.get(key);
  };
  for (const model of data.models) {
    model.points = words(model.points, Float32Array);
    model.triangles = words(model.triangles, Uint32Array);
  }
  const state = { model: data.models.length > 1 ? data.models.length - 1 : 0, field: data.fields[Math.min(2, data.fields.length - 1)].name, step: data.steps.length - 1, curve: 0, at: null };

  const written = (value) => {
    if (!Number.isFinite(value)) return "–";
    const size = Math.abs(value);
    return size !== 0 && (size < 1e-3 || size >= 1e5) ? value.toExponential(3) : String(Number(value.toPrecision(5)));
  };
  const deformed = (model, step) => {
    const [ux, uy] = ["ux", "uy"].map((name) => field(model, name, step));
    if (!ux) return null;
    const places = new Float64Array(model.points.length);
    for (let n = 0; n < ux.length; n++) {
      places[2 * n] = model.points[2 * n] + ux[n];
      places[2 * n + 1] = model.points[2 * n + 1] + uy[n];
    }
    return places;
  };
  // What all models reach at all steps, so that nothing jumps.
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  for (const model of data.models)
    data.steps.forEach((_, step) => {
      const places = deformed(model, step) || [];
      for (let n = 0; n < places.length; n++) {
        if (!Number.isFinite(places[n])) continue;
        box[n % 2] = Math.min(box[n % 2], places[n]);
        box[2 + (n % 2)] = Math.max(box[2 + (n % 2)], places[n]);
      }
    });
  const area = (model, t) => {
    const [[ax, ay], [bx, by], [cx, cy]] = [0, 1, 2].map((corner) => model.triangles[t + corner]).map((n) => [model.points[2 * n], model.points[2 * n + 1]]);
    return Math.abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax));
  };
  // The range of colours at a step, of all models: without a hundredth of the area at each end.
  const ranges = new Map();
  const range = (step) => {
    const key = state.field + "|" + step;
    if (!ranges.has(key)) ranges.set(key, rangeAt(step));
    return ranges.get(key);
  };
  const rangeAt = (step) => {
    const ends = data.models.map((model) => {
      const all = field(model, state.field, step);
      if (!all) return null;
      const parts = [];
      for (let t = 0; t < model.triangles.length; t += 3) {
        const value = (all[model.triangles[t]] + all[model.triangles[t + 1]] + all[model.triangles[t + 2]]) / 3;
        if (Number.isFinite(value)) parts.push([value, area(model, t)]);
      }
      parts.sort((a, b) => a[0] - b[0]);
      const whole = parts.reduce((sum, part) => sum + part[1], 0);
      const within = (share) => {
        let passed = 0;
        return (parts.find((part) => (passed += part[1]) >= share * whole) || [NaN])[0];
      };
      return parts.length ? [within(0.01), within(0.99)] : null;
    });
    const found = ends.filter(Boolean);
    let [low, high] = [Math.min(...found.map((end) => end[0])), Math.max(...found.map((end) => end[1]))];
    if (!(low < high)) [low, high] = [low - (Math.abs(low) || 1) * 0.1, low + (Math.abs(low) || 1) * 0.1];
    const signed = low < 0 && high > 0 && Math.min(-low, high) > 0.02 * Math.max(-low, high);
    if (signed) [low, high] = [-Math.max(-low, high), Math.max(-low, high)];
    return { low, high, table: signed ? tables.signed : tables.even };
  };
  const size = (canvas, ratio) => {
    const scale = window.devicePixelRatio || 1;
    canvas.width = Math.max(50, Math.round(canvas.clientWidth * scale));
    canvas.height = Math.round(canvas.width * ratio);
    canvas.style.height = canvas.height / scale + "px";
    return scale;
  };
  const layout = (canvas) => {
    const margin = 8;
    const scale = Math.min((canvas.width - 2 * margin) / (box[2] - box[0]), (canvas.height - 2 * margin) / (box[3] - box[1]));
    return { scale, place: (x, y) => [margin + (x - box[0]) * scale, margin + (box[3] - y) * scale], back: (px, py) => [box[0] + (px - margin) / scale, box[3] - (py - margin) / scale] };
  };
  const shade = (image, corners, shares, table) => {
    const [[ax, ay], [bx, by], [cx, cy]] = corners;
    const double = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    if (!(Math.abs(double) > 0)) return;
    const top = Math.max(0, Math.ceil(Math.min(ay, by, cy) - 0.5));
    const bottom = Math.min(image.height - 1, Math.floor(Math.max(ay, by, cy) - 0.5));
    const left = Math.max(0, Math.ceil(Math.min(ax, bx, cx) - 0.5));
    const right = Math.min(image.width - 1, Math.floor(Math.max(ax, bx, cx) - 0.5));
    for (let row = top; row <= bottom; row++)
      for (let column = left; column <= right; column++) {
        const [x, y] = [column + 0.5 - ax, row + 0.5 - ay];
        const b = (x * (cy - ay) - y * (cx - ax)) / double;
        const c = (y * (bx - ax) - x * (by - ay)) / double;
        if (b < -1e-6 || c < -1e-6 || b + c > 1 + 1e-6) continue;
        const share = shares[0] + b * (shares[1] - shares[0]) + c * (shares[2] - shares[0]);
        const colour = Number.isFinite(share) ? 3 * Math.max(0, Math.min(255, Math.floor(256 * share))) : -1;
        for (let part = 0; part < 3; part++) image.data[4 * (row * image.width + column) + part] = colour < 0 ? 200 : table[colour + part];
        image.data[4 * (row * image.width + column) + 3] = 255;
      }
  };
  const drawField = () => {
    const canvas = element("field");
    size(canvas, Math.min(0.9, (box[3] - box[1]) / (box[2] - box[0]) + 0.03));
    const context = canvas.getContext("2d");
    const image = context.createImageData(canvas.width, canvas.height);
    const model = data.models[state.model];
    const places = deformed(model, state.step);
    const all = field(model, state.field, state.step);
    const { low, high, table } = range(state.step);
    const { place } = layout(canvas);
    if (places && all)
      for (let t = 0; t < model.triangles.length; t += 3) {
        const nodes = [0, 1, 2].map((corner) => model.triangles[t + corner]);
        shade(image, nodes.map((n) => place(places[2 * n], places[2 * n + 1])), nodes.map((n) => (all[n] - low) / (high - low)), table);
      }
    context.putImageData(image, 0, 0);
    if (state.at && state.shown) {
      const [x, y] = place(...state.shown);
      context.beginPath();
      context.arc(x, y, 5, 0, 7);
      context.lineWidth = 3;
      context.strokeStyle = "#fff";
      context.stroke();
      context.lineWidth = 1.5;
      context.strokeStyle = "#000";
      context.stroke();
    }
    const bar = element("bar");
    bar.width = 256;
    bar.height = 1;
    const colours = bar.getContext("2d").createImageData(256, 1);
    for (let n = 0; n < 256; n++) colours.data.set([table[3 * n], table[3 * n + 1], table[3 * n + 2], 255], 4 * n);
    bar.getContext("2d").putImageData(colours, 0, 0);
    element("low").textContent = written(low);
    element("high").textContent = written(high);
    element("reached").textContent = places ? "" : "This model has no solution here.";
  };
  // The triangle under a place, at rest or deformed, and the shares of its corners.
  const find = (model, places, [px, py]) => {
    for (let t = 0; t < model.triangles.length; t += 3) {
      const nodes = [0, 1, 2].map((corner) => model.triangles[t + corner]);
      const [[ax, ay], [bx, by], [cx, cy]] = nodes.map((n) => [places[2 * n], places[2 * n + 1]]);
      const double = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
      const b = ((px - ax) * (cy - ay) - (py - ay) * (cx - ax)) / double;
      const c = ((py - ay) * (bx - ax) - (px - ax) * (by - ay)) / double;
      if (b >= -1e-6 && c >= -1e-6 && b + c <= 1 + 1e-6) return { nodes, shares: [1 - b - c, b, c] };
    }
    return null;
  };
  const mean = ({ nodes, shares }, all) => nodes.reduce((sum, n, corner) => sum + shares[corner] * all[n], 0);
  // The place at rest is kept, so that it moves with the sheet and is the same in all models.
  const read = () => {
    const rows = [];
    state.shown = null;
    const heads = data.models.map((model) => model.label);
    const found = data.models.map((model) => state.at && find(model, model.points, state.at));
    const own = found[state.model];
    if (own) {
      const places = deformed(data.models[state.model], state.step);
      if (places) state.shown = [0, 1].map((axis) => own.nodes.reduce((sum, n, corner) => sum + own.shares[corner] * places[2 * n + axis], 0));
      for (const { name, label } of data.fields)
        rows.push([label, ...data.models.map((model, index) => {
          const all = field(model, name, state.step);
          return all && found[index] ? written(mean(found[index], all)) : "–";
        })]);
    }
    const title = own ? "at rest at (" + state.at.map(written).join(", ") + ") mm" : "point at a place of the sheet";
    fill(element("values"), [title, ...heads], rows);
  };
  const fill = (table, head, rows) => {
    const cell = (kind, text, index) => {
      const made = document.createElement(kind);
      made.textContent = text;
      if (index > 0) made.className = "number";
      return made;
    };
    table.replaceChildren();
    [["th", head], ...rows.map((row) => ["td", row])].forEach(([kind, row]) => {
      table.insertRow().append(...row.map((text, index) => cell(kind, text, index)));
    });
  };
  // A place on the path in words.
  const described = (at) => {
    if (data.along === "stretch") return "stretch " + written(100 * at) + " %";
    return data.along + " " + written(at) + (data.along === "time" ? " s" : "");
  };
  const colour = (name) => data.lines[name] || "#009e73";
  const frame = (canvas) => {
    const curve = data.curves[state.curve];
    const all = Object.values(curve.models).flat().map((point) => point[1]).filter(Number.isFinite);
    const at = data.steps.map((step) => step.at);
    const [left, right] = [Math.min(0, ...at), Math.max(0, ...at)];
    const [low, high] = [Math.min(0, ...all), Math.max(0, ...all)];
    const scale = window.devicePixelRatio || 1;
    const [x0, x1, y0, y1] = [12 * scale, canvas.width - 12 * scale, canvas.height - 22 * scale, 20 * scale];
    return {
      ends: { left, right, low, high },
      curve,
      x: (value) => x0 + ((value - left) / (right - left || 1)) * (x1 - x0),
      y: (value) => y0 + ((value - low) / (high - low || 1)) * (y1 - y0),
      back: (px) => left + ((px - x0) / (x1 - x0)) * (right - left),
    };
  };
  const drawCurve = () => {
    if (!data.curves.length) return;
    const canvas = element("curve");
    const scale = size(canvas, 0.3);
    const context = canvas.getContext("2d");
    const { curve, x, y, ends } = frame(canvas);
    context.clearRect(0, 0, canvas.width, canvas.height);
    context.strokeStyle = "#ccc";
    context.lineWidth = scale;
    for (const line of [[x(0), 0, x(0), canvas.height], [0, y(0), canvas.width, y(0)]]) {
      context.beginPath();
      context.moveTo(line[0], line[1]);
      context.lineTo(line[2], line[3]);
      context.stroke();
    }
    // The ends of both axes, in words.
    context.fillStyle = "#555";
    context.font = 11 * scale + "px sans-serif";
    const unit = (curve.label.match(/\[[^\]]*\]$/) || [""])[0].slice(1, -1);
    const end = (value) => written(value) + (unit && unit !== "–" ? " " + unit : "");
    const text = (words, at, height, align) => {
      context.textAlign = align;
      context.fillText(words, at, height);
    };
    text(described(ends.left), x(ends.left), canvas.height - 6 * scale, "left");
    text(described(ends.right), x(ends.right), canvas.height - 6 * scale, "right");
    if (ends.high !== 0) text(end(ends.high), x(ends.left) + 4 * scale, y(ends.high) - 6 * scale, "left");
    if (ends.low !== 0) text(end(ends.low), x(ends.left) + 4 * scale, y(ends.low) - 4 * scale, "left");
    const now = x(data.steps[state.step].at);
    context.fillStyle = "#0072b222";
    context.fillRect(now - 4 * scale, 0, 8 * scale, canvas.height);
    Object.entries(curve.models).forEach(([name, points]) => {
      context.strokeStyle = context.fillStyle = colour(name);
      // Nothing was computed between the points: thin dashes, unless there are so many points that they are a line.
      const few = points.length <= 60;
      context.lineWidth = (few ? 1 : 2) * scale;
      context.setLineDash(few ? [3 * scale, 4 * scale] : []);
      context.beginPath();
      points.forEach(([at, value]) => context.lineTo(x(at), y(value)));
      context.stroke();
      context.setLineDash([]);
      if (few)
        points.forEach(([at, value]) => {
          context.beginPath();
          context.arc(x(at), y(value), 3 * scale, 0, 7);
          context.fill();
        });
    });
    const current = data.steps[state.step].at;
    const here = (points) => points.find((point) => point[0] === current) || [];
    const rows = Object.entries(curve.models).map(([name, points]) => [name, written(here(points)[1])]);
    fill(element("forces"), [described(data.steps[state.step].at), curve.label], rows);
    [...element("forces").rows].slice(1).forEach((row) => (row.cells[0].style.color = colour(row.cells[0].textContent)));
  };
  const show = () => {
    element("step").value = state.step;
    element("at").textContent = described(data.steps[state.step].at);
    element("model").value = state.model;
    element("name").value = state.field;
    read();
    drawField();
    drawCurve();
  };
  const option = (select, value, label) => select.append(new Option(label, value));
  data.models.forEach((model, index) => option(element("model"), index, model.label));
  data.fields.forEach(({ name, label }) => option(element("name"), name, label));
  data.curves.forEach(({ label }, index) => option(element("quantity"), index, label));
  element("step").max = data.steps.length - 1;
  const choose = (name, key, number) =>
    element(name).addEventListener("input", (event) => {
      state[key] = number ? Number(event.target.value) : event.target.value;
      show();
    });
  choose("model", "model", true);
  choose("name", "field", false);
  choose("step", "step", true);
  choose("quantity", "curve", true);
  const pixel = (canvas, event) => {
    const area = canvas.getBoundingClientRect();
    return [event.clientX - area.left, event.clientY - area.top].map((part) => (part * canvas.width) / area.width);
  };
  const point = (event) => {
    const canvas = element("field");
    const model = data.models[state.model];
    const places = deformed(model, state.step);
    const found = places && find(model, places, layout(canvas).back(...pixel(canvas, event)));
    if (!found) return;
    state.at = [0, 1].map((axis) => found.nodes.reduce((sum, n, corner) => sum + found.shares[corner] * model.points[2 * n + axis], 0));
    show();
  };
  element("field").addEventListener("pointermove", point);
  element("field").addEventListener("pointerdown", point);
  const drag = (event) => {
    if (event.type === "pointermove" && !event.buttons) return;
    const canvas = element("curve");
    const wanted = frame(canvas).back(pixel(canvas, event)[0]);
    const distance = (step) => Math.abs(step.at - wanted);
    state.step = data.steps.reduce((best, step, index) => (distance(step) < distance(data.steps[best]) ? index : best), 0);
    show();
  };
  if (data.curves.length) {
    element("curve").addEventListener("pointerdown", drag);
    element("curve").addEventListener("pointermove", drag);
  } else element("along").hidden = true;
  window.addEventListener("resize", show);
  document.getElementById("explorer").hidden = false;
  show();
})();
