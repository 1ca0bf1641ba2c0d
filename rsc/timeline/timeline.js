// Draws a run (recorder.hpp says what is in it). All lanes share one window of time; what lies outside of it is not drawn, and
// what is narrower than a pixel is drawn once a pixel, so that a hundred thousand events stay smooth.
"use strict";

const run = JSON.parse(document.getElementById("run").textContent);
const SVG = "http://www.w3.org/2000/svg";
// Colours by Okabe and Ito, and hatchings for who sees or prints no colours: paths in a cell of 8 by 8 pixels. From the ninth
// behaviour on, the outlines are dashed.
const COLOURS = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#b8a800", "#777777"];
const RISING = "M-1,1l2,-2M0,8l8,-8M7,9l2,-2", FALLING = "M-1,7l2,2M0,0l8,8M7,-1l2,2";
const HATCHINGS = ["", RISING, "M3.5,0v8", FALLING, "M0,3.5h8", RISING + FALLING, "M1,1.5h2v1h-2M5,5.5h2v1h-2", "M3.5,0v8M0,3.5h8"];
const PAPER = 540;  // pixels for a lane that is printed: paper is that wide beside the names
const BEGIN = run.begin_us, END = Math.max(run.end_us, BEGIN + 1);
const MARGIN = 8;  // pixels at both ends of a lane
const steps = new Map(run.steps.map(([step, ...words]) => [step, words]));
const lanes = [];
let from = BEGIN, to = END, chosen = null;

// ---- words

const seconds = us => (us / 1e6).toFixed(3) + " s";

function shown(signal, value) {
  if (value === null) return "unknown";
  if (signal.labels.length > 0) return signal.labels[value / 1000] ?? String(value / 1000);
  const unit = signal.unit;
  const number = (value * unit.divisor - unit.offset) / unit.factor;
  return String(Math.round(number * 1000) / 1000) + unit.name;
}

const behaviorName = index => run.behaviors[index] || "rules outside a behaviour";
const ruleName = rule => rule === null ? "" : run.rules[rule].name;

// What happened in one step, behind a heading.
function why(item) {
  const lines = (steps.get(item.step) ?? []).map(words => "• " + words);
  return [item.heading, ...lines].join("\n");
}

// ---- drawing

function element(name, attributes = {}, text = null) {
  const made = document.createElementNS(SVG, name);
  for (const key in attributes) made.setAttribute(key, attributes[key]);
  if (text !== null) made.textContent = text;
  return made;
}

function paint(behavior) {
  const kind = behavior % COLOURS.length;
  const dashed = behavior >= COLOURS.length ? "5 3" : "none";
  return behavior < 0 ? {"fill": "#fff", "stroke": "#000"} :
    {"fill": `url(#hatching${kind})`, "stroke": COLOURS[kind], "stroke-dasharray": dashed};
}

function hatchings() {
  const made = element("svg", {width: 0, height: 0, style: "position: absolute"});
  COLOURS.forEach((colour, kind) => {
    const cell = element("pattern", {id: "hatching" + kind, width: 8, height: 8, patternUnits: "userSpaceOnUse"});
    cell.append(element("path", {d: "M0,0h8v8h-8z", fill: colour, "fill-opacity": 0.25}),
      element("path", {d: HATCHINGS[kind], stroke: colour}));
    made.append(cell);
  });
  return made;
}

const widthOf = lane => lane.width - 2 * MARGIN;
const place = (lane, us) => MARGIN + (us - from) / (to - from) * widthOf(lane);
const timeAt = (lane, x) => from + (x - MARGIN) / widthOf(lane) * (to - from);

// The first of `items`, sorted by `key`, that does not come before `time`.
function firstFrom(items, key, time) {
  let low = 0, high = items.length;
  while (low < high) {
    const middle = low + high >> 1;
    if (key(items[middle]) < time) low = middle + 1; else high = middle;
  }
  return low;
}

const ruler = document.createElement("canvas").getContext("2d");
ruler.font = "12px system-ui, sans-serif";
const lengthOf = text => ruler.measureText(text).width;

// A text, shortened if there is no room for all of it. Returns whether it is drawn: not where another one is, and not if
// next to nothing would be left of it.
function label(lane, x, y, room, text, quiet = false) {
  if (room < 24) return false;
  let short = text;
  for (let kept = Math.min(text.length, room >> 1); lengthOf(short) > room; --kept) {
    if (kept < 4) return false;
    short = text.slice(0, kept).trim() + "…";
  }
  const right = x + lengthOf(short);
  if (lane.texts.some(other => x < other.right && other.x < right && Math.abs(y - other.y) < 13)) return false;
  lane.texts.push({x, y, right});
  lane.svg.append(element("text", quiet ? {x, y, class: "quiet"} : {x, y}, short));
  return true;
}

// A picture on lights, each of `size` pixels: the picture's width, in pixels; 0 if there is none.
const LIGHTS = 5;

function drawPicture(into, index, x, y, size) {
  if (index === undefined) return 0;
  const lit = run.pictures[index].flatMap((row, r) => [...row].map((light, column) =>
    light === "#" ? `M${x + 1 + column * size},${y + 1 + r * size}h${size - 1}v${size - 1}h${1 - size}z` : ""));
  const width = LIGHTS * size + 1;
  into.append(element("rect", {x, y, width, height: width, class: "dark"}), element("path", {d: lit.join(""), class: "lit"}));
  return width;
}

// The picture of a bar, if it has one, and its text, in a row whose middle is at `y`.
function caption(lane, bar, x, y, room, text) {
  const width = room < 24 ? 0 : drawPicture(lane.svg, bar.picture, x, y - 10, 4);
  const left = width ? width + 4 : 0;
  label(lane, x + left, y + 4, room - left, text);
}

// Things with a beginning and an end, sorted, of which none overlaps another; those of one pixel are drawn once.
function drawSpans(lane, spans, draw) {
  let last = -Infinity;
  for (let i = Math.max(firstFrom(spans, span => span.from, from) - 1, 0); i < spans.length && spans[i].from <= to; ++i) {
    const span = spans[i];
    if (span.to < from) continue;
    const left = Math.max(place(lane, span.from), 0);
    const right = Math.min(place(lane, span.to), lane.width);
    const width = Math.max(right - left, 2);
    if (left + width - last < 1) continue;
    last = left + width;
    draw(span, left, width);
  }
}

function selectable(shape, item) {
  shape.item = item;
  if (item === chosen) shape.classList.add("chosen");
  return shape;
}

function drawBars(lane) {
  for (const [begin, end] of lane.of.halts) {
    if (end < from || begin > to) continue;
    const x = place(lane, begin);
    lane.svg.append(element("rect", {x, y: 2, width: Math.max(place(lane, end) - x, 2), height: lane.height - 4, class: "halt"}));
    label(lane, Math.max(x, 0) + 4, lane.height / 2 + 4, place(lane, end) - Math.max(x, 0) - 6, "halted");
  }
  // What lasts when its command is done: a thin bar, up to the next command.
  const lasting = lane.of.bars.filter(bar => bar.until > bar.to).map(bar => ({...bar, from: bar.to, to: bar.until, bar}));
  drawSpans(lane, lasting, (rest, x, width) => {
    const shape = element("rect", {x, y: lane.height - 10, width, height: 6, class: "lasting", ...paint(rest.behavior)});
    lane.svg.append(selectable(shape, rest.bar));
    caption(lane, rest, x + 4, 12, width - 6, rest.text);
  });
  drawSpans(lane, lane.of.bars, (bar, x, width) => {
    const shape = element("rect", {x, y: 4, width, height: lane.height - 8, rx: 2, class: "bar", ...paint(bar.behavior)});
    lane.svg.append(selectable(shape, bar));
    const owner = run.behaviors[bar.behavior];
    caption(lane, bar, x + 4, lane.height / 2, width - 6, owner ? `${bar.text}  (${owner})` : bar.text);
  });
}

function drawSegments(lane) {
  drawSpans(lane, lane.spans, (span, x, width) => {
    const fill = span.value === null ? "#eee" : `hsl(${210 + 40 * (span.value / 1000 % 6)} 40% 92%)`;
    lane.svg.append(element("rect", {x, y: 4, width, height: lane.height - 8, fill, class: "segment"}));
    label(lane, x + 4, lane.height / 2 + 4, width - 6, shown(lane.of, span.value));
  });
}

// The curve lies on top of all texts, and its lane has room for one above and below it.
function drawCurve(lane) {
  const {of: {thresholds}, low, high} = lane;
  const y = value => lane.height - 16 - (value - low) / (high - low || 1) * (lane.height - 32);
  const d = curve(lane, y);
  const within = thresholds.filter(one => low <= one.value && one.value <= high);
  const lines = within.map(one => y(one.value));
  for (const at of lines) lane.svg.append(element("line", {x1: 0, x2: lane.width, y1: at, y2: at, class: "threshold"}));
  for (const [value, base] of [[high, 12], [low, lane.height - 3]]) {
    const text = shown(lane.of, value);
    label(lane, lane.width - lengthOf(text) - 2, base, lane.width, text, true);
  }
  for (const one of within) labelThreshold(lane, one, y, lines);
  if (d) lane.svg.append(element("path", {d, class: "curve"}));
}

// Above its line or below; further right, if other texts, lines or the curve are there.
function labelThreshold(lane, one, y, lines) {
  const value = shown(lane.of, one.value), at = y(one.value);
  const text = one.rule === null ? `${one.text} from ${value}` : `${one.text} ${value}, ${ruleName(one.rule)}`;
  const room = lane.width / 3;
  for (const crossing of [false, true])
    for (const x of [4, 4 + room, 4 + 2 * room])
      for (const base of [at - 3, at + 12])
        if (crossing || !lines.some(line => base - 11 < line && line < base + 2) && !crossed(lane, y, x, x + lengthOf(text), base))
          if (label(lane, x, base, room - 16, text, true)) return;
}

// Whether the curve goes through a text that has this base and lies between these places.
function crossed(lane, y, left, right, base) {
  const points = lane.of.points;
  const [first, end] = [left, right].map(x => firstFrom(points, point => point[0], timeAt(lane, x)));
  const near = points.slice(Math.max(first - 1, 0), end).filter(point => point[1] !== null).map(point => y(point[1]));
  return near.some(height => height > base - 11) && near.some(height => height < base + 2);
}

// Draws when the sensor is unknown. Returns the path of the readings: of all in one column of pixels, the least and the greatest.
function curve(lane, y) {
  const points = lane.of.points;
  let path = "", column = null, least = 0, most = 0, pen = false;
  const flush = () => { if (column !== null && least !== most) path += `V${y(least)}V${y(most)}`; };
  for (let i = Math.max(firstFrom(points, point => point[0], from) - 1, 0); i < points.length && points[i][0] <= to; ++i) {
    const [at, value] = points[i];
    const x = Math.max(place(lane, at), 0);
    if (value === null) {
      if (pen) path += `H${x}`;
      pen = false;
      const end = Math.min(place(lane, points[i + 1]?.[0] ?? END), lane.width);
      lane.svg.append(element("rect", {x, y: 0, width: Math.max(end - x, 1), height: lane.height, class: "unknown"}));
      label(lane, x + 4, lane.height / 2 + 4, end - x - 6, "unknown", true);
      continue;
    }
    if (pen && Math.floor(x) === column) {
      least = Math.min(least, value);
      most = Math.max(most, value);
      path += i + 1 === points.length ? `V${y(value)}` : "";
      continue;
    }
    flush();
    path += pen ? `H${x}V${y(value)}` : `M${x},${y(value)}`;
    [column, least, most, pen] = [Math.floor(x), value, value, true];
  }
  flush();
  return pen ? path + `H${Math.min(place(lane, END), lane.width)}` : path;
}

function drawMarks(lane) {
  let last = -Infinity;
  const marks = lane.of.marks;
  for (let i = firstFrom(marks, mark => mark.at, from); i < marks.length && marks[i].at <= to; ++i) {
    const x = place(lane, marks[i].at), y = lane.height / 2;
    if (x - last < 1) continue;
    const room = Math.min(marks[i + 1] ? place(lane, marks[i + 1].at) : lane.width, lane.width) - x - 10;
    last = x;
    const shape = marks[i].kind === "denied"
      ? element("path", {d: `M${x - 5},${y - 5}l10,10m0,-10l-10,10`, class: "mark denied", stroke: paint(marks[i].behavior).stroke})
      : element("path", {d: `M${x},${y - 6}l5,6l-5,6l-5,-6z`, class: "mark " + marks[i].kind});
    lane.svg.append(selectable(shape, marks[i]));
    label(lane, x + 8, y + 4, room, marks[i].text);
  }
}

function drawTrips(lane) {
  drawSpans(lane, lane.of.trips, (trip, x, width) => {
    const shape = element("rect", {x, y: 4, width, height: lane.height - 8, class: "bar trip"});
    lane.svg.append(selectable(shape, trip));
  });
}

function drawAxis(lane) {
  const rough = (to - from) / Math.max(widthOf(lane) / 90, 1);
  const power = 10 ** Math.floor(Math.log10(Math.max(rough, 1000)));
  const step = [1, 2, 5, 10].map(n => n * power).find(n => n >= rough);
  const digits = Math.max(0, Math.min(3, Math.ceil(-Math.log10(step / 1e6))));
  for (let at = Math.ceil(from / step) * step; at <= to; at += step) {
    const x = place(lane, at);
    lane.svg.append(element("line", {x1: x, x2: x, y1: 16, y2: lane.height, class: "grid"}));
    const text = (at / 1e6).toFixed(digits) + " s";
    label(lane, Math.min(x + 3, lane.width - lengthOf(text)), 14, lane.width, text);
  }
}

// `width`: of a lane; without it, what the window has.
function draw(width) {
  for (const lane of lanes) lane.width = width ?? lane.svg.clientWidth;  // all at once: asking lays the page out
  for (const lane of lanes) {
    lane.texts = [];
    lane.svg.setAttribute("viewBox", `0 0 ${lane.width} ${lane.height}`);  // paper may be narrower or wider
    lane.svg.replaceChildren();
    lane.draw(lane);
  }
}

// ---- lanes

function heading(text) {
  const made = document.createElement("div");
  made.className = "group";
  made.textContent = text;
  document.getElementById("lanes").append(made);
}

function addLane(name, note, height, of, drawn) {
  const row = document.createElement("div");
  row.className = "lane";
  const title = document.createElement("div");
  title.className = "name";
  title.textContent = name;
  if (note) title.append(document.createElement("br"), Object.assign(document.createElement("small"), {textContent: note}));
  const svg = element("svg", {height, role: "img", "aria-label": name});
  row.append(title, svg);
  document.getElementById("lanes").append(row);
  lanes.push({svg, height, of, draw: drawn, name});
  return lanes.at(-1);
}

// A list for each key, in the order in which the keys first appear.
function grouped(items, keyOf) {
  const groups = new Map();
  for (const item of items) {
    if (!groups.has(keyOf(item))) groups.set(keyOf(item), []);
    groups.get(keyOf(item)).push(item);
  }
  return groups;
}

function addSignal(signal) {
  if (signal.labels.length > 0) {
    const lane = addLane(signal.name, "", 28, signal, drawSegments);
    lane.spans = signal.points.map(([at, value], i) => ({from: at, to: signal.points[i + 1]?.[0] ?? END, value}));
    return;
  }
  const values = signal.points.map(point => point[1]).filter(value => value !== null);
  const near = signal.thresholds.map(one => one.value);
  const all = [...values, ...near];
  const lane = addLane(signal.name, "", 72, signal, drawCurve);
  lane.low = all.reduce((a, b) => Math.min(a, b), all[0] ?? 0);
  lane.high = all.reduce((a, b) => Math.max(a, b), all[0] ?? 1000);
}

function withHeadings() {
  for (const lane of run.actuators)
    for (const bar of lane.bars)
      bar.heading = `${seconds(bar.from)} to ${seconds(bar.to)}: ${lane.name} ${bar.text}` +
        (bar.rule === null ? "" : `\n${behaviorName(bar.behavior)}, rule at ${ruleName(bar.rule)}`);
  for (const mark of [...run.denied, ...run.messages]) mark.heading = `${seconds(mark.at)}: ${mark.text}`;
  for (const mark of run.denied) mark.kind = "denied";
  for (const trip of run.safety) trip.heading = `${seconds(trip.from)} to ${seconds(trip.to)}: SAFETY, rule at ${ruleName(trip.rule)}`;
}

function build() {
  document.querySelector("h1").textContent = document.title;
  withHeadings();
  addLane("", "", 22, {}, drawAxis);
  const of = group => run.signals.filter(signal => signal.group === group);
  const variables = of("variable"), sensors = of("sensor");
  if (variables.length + run.safety.length + run.messages.length > 0) heading("What it feels, knows and says");
  for (const [rule, trips] of grouped(run.safety, trip => trip.rule)) addLane("SAFETY", ruleName(rule), 30, {trips}, drawTrips);
  variables.forEach(addSignal);
  if (run.messages.length > 0) addLane("log and alerts", "", 24, {marks: run.messages}, drawMarks);
  heading("What it does");
  for (const actuator of run.actuators) addLane(actuator.name, "", 34, actuator, drawBars);
  if (run.denied.length > 0) heading("What it wanted to do, and was denied");
  for (const [index, marks] of grouped(run.denied, mark => mark.behavior)) addLane(behaviorName(index), "", 24, {marks}, drawMarks);
  if (sensors.length > 0) heading("What it senses");
  sensors.forEach(addSignal);
  buildLegend();
  buildSource();
}

function buildLegend() {
  document.body.append(hatchings());
  const seen = new Set(run.actuators.flatMap(lane => lane.bars.map(bar => bar.behavior)));
  for (const index of [...seen].sort((a, b) => a - b)) {
    const entry = document.createElement("li");
    const swatch = element("svg", {width: 16, height: 14});
    swatch.append(element("rect", {x: 1, y: 1, width: 14, height: 12, ...paint(index)}));
    entry.append(swatch, behaviorName(index));
    document.getElementById("legend").append(entry);
  }
}

function buildSource() {
  const lines = run.source.map((text, i) => {
    const line = document.createElement("span");
    line.id = "line" + (i + 1);
    line.textContent = String(i + 1).padStart(4) + "  " + text + "\n";
    return line;
  });
  document.getElementById("source").append(...lines);
}

// ---- hands

function show(begin, end) {
  const span = Math.min(Math.max(end - begin, 1000), END - BEGIN);
  from = Math.min(Math.max(begin, BEGIN), END - span);
  to = from + span;
  draw();
}

function zoom(factor, at = (from + to) / 2) {
  show(at - (at - from) * factor, at + (to - at) * factor);
}

function tell(event) {
  const tip = document.getElementById("tip");
  const lane = lanes.find(one => one.svg.contains(event.target));
  const item = event.target.item;
  const curve = lane && lane.of.points;
  tip.hidden = !item && !curve;
  if (item) {
    tip.textContent = why(item);
    const large = element("svg");
    const width = drawPicture(large, item.picture, 0, 0, 12);
    if (width) {
      for (const side of ["width", "height"]) large.setAttribute(side, width);
      tip.prepend(large);
    }
  }
  else if (curve) {
    const at = timeAt(lane, event.clientX - lane.svg.getBoundingClientRect().left);
    const index = firstFrom(curve, point => point[0], at + 1) - 1;
    tip.textContent = `${seconds(at)}: ${lane.of.name} ${index < 0 ? "unknown" : shown(lane.of, curve[index][1])}`;
  }
  tip.style.left = Math.min(event.clientX + 12, innerWidth - tip.offsetWidth - 8) + "px";
  tip.style.top = Math.min(event.clientY + 12, innerHeight - tip.offsetHeight - 8) + "px";
}

function choose(item) {
  chosen = item ?? null;
  for (const line of document.querySelectorAll("#source .here")) line.classList.remove("here");
  const rule = item && item.rule !== null && item.rule !== undefined ? run.rules[item.rule] : null;
  const line = rule && document.getElementById("line" + rule.line);
  if (line) {
    line.classList.add("here");
    line.scrollIntoView({block: "nearest"});
  }
  draw();
}

function listen() {
  const main = document.getElementById("lanes");
  let drag = null;
  main.addEventListener("wheel", event => {
    const lane = lanes.find(one => one.svg.contains(event.target));
    if (!lane) return;
    event.preventDefault();
    zoom(event.deltaY > 0 ? 1.25 : 0.8, timeAt(lane, event.clientX - lane.svg.getBoundingClientRect().left));
  }, {passive: false});
  main.addEventListener("pointerdown", event => {
    const lane = lanes.find(one => one.svg.contains(event.target));
    if (lane) drag = {lane, x: event.clientX, from, to, moved: false, item: event.target.item};
  });
  addEventListener("pointermove", event => {
    tell(event);
    if (!drag || Math.abs(event.clientX - drag.x) < 3 && !drag.moved) return;
    drag.moved = true;
    const shift = (event.clientX - drag.x) / widthOf(drag.lane) * (drag.to - drag.from);
    show(drag.from - shift, drag.to - shift);
  });
  addEventListener("pointerup", () => {
    if (drag && !drag.moved) choose(drag.item);
    drag = null;
  });
  addEventListener("resize", () => draw());
  addEventListener("beforeprint", () => draw(PAPER));
  addEventListener("afterprint", () => draw());
  const keys = {"+": () => zoom(0.8), "=": () => zoom(0.8), "-": () => zoom(1.25), "0": () => show(BEGIN, END),
    "ArrowLeft": () => show(from - (to - from) / 5, to - (to - from) / 5),
    "ArrowRight": () => show(from + (to - from) / 5, to + (to - from) / 5)};
  addEventListener("keydown", event => keys[event.key]?.());
  document.getElementById("in").onclick = keys["+"];
  document.getElementById("out").onclick = keys["-"];
  document.getElementById("all").onclick = keys["0"];
}

build();
draw();
listen();
