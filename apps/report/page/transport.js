// Play, pause, speed, slow motion, the time slider and its events; the keys do the same.
import {element} from "./element.js";
import {clockTime} from "./format.js";

const kSpeeds = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10];
const kMaxMarks = 400;

export const kKeys = [
  ["Space", "play or pause"],
  ["← →", "one step back, forward; with Shift ten"],
  ["P N", "event before, next event"],
  ["[ ]", "slower, faster"],
  ["S", "slow motion near events"],
  ["Home End", "to the start, to the end"],
  ["F", "the view as it was"],
  ["Z", "the plots' whole time"],
  ["T", "light or dark"],
  ["?", "this list"],
];

function icon(path) {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg"), shape = document.createElementNS("http://www.w3.org/2000/svg", "path");
  svg.setAttribute("viewBox", "0 0 16 16");
  svg.setAttribute("aria-hidden", "true");
  shape.setAttribute("d", path);
  svg.append(shape);
  return svg;
}

const kPlay = "M4 2.5v11l9.5-5.5z", kPause = "M3.5 2.5h3v11h-3zM9.5 2.5h3v11h-3z";
const kBefore = "M3 3h2v10H3zM13 3v10L6 8z", kNext = "M11 3h2v10h-2zM3 3v10l7-5z";

export function makeTransport(clock, events) {
  const span = clock.end - clock.start;
  const play = element("button", {class: "play", type: "button", onclick: () => clock.toggle()});
  const slider = element("input", {
    type: "range", min: clock.start, max: clock.end, step: "any", "aria-label": "Time", oninput: () => clock.go(slider.valueAsNumber),
  });
  const readout = element("output", {class: "time", "aria-live": "off"});
  const speed = element("select", {"aria-label": "Speed", onchange: () => clock.setSpeed(Number(speed.value))},
                        ...kSpeeds.map((s) => element("option", {value: s}, `${s}×`)));
  const slow = element("input", {type: "checkbox", onchange: () => clock.setSlow(slow.checked)});
  const jump = (label, path, direction) =>
      element("button", {type: "button", "aria-label": label, title: label, onclick: () => clock.jump(direction)}, icon(path));

  const marks = element("div", {class: "marks", "aria-hidden": "true"});
  for (const event of events.slice(0, kMaxMarks)) {
    marks.append(element("i", {style: `left: ${(100 * (event.t - clock.start)) / (span || 1)}%`, title: event.text}));
  }
  clock.listen(() => {
    play.replaceChildren(icon(clock.playing ? kPause : kPlay));
    play.setAttribute("aria-label", clock.playing ? "Pause" : "Play");
    if (document.activeElement !== slider || clock.playing || slider.valueAsNumber !== clock.t) slider.value = clock.t;
    slider.setAttribute("aria-valuetext", clockTime(clock.t, span));
    slider.style.setProperty("--share", (clock.t - clock.start) / (span || 1));
    readout.textContent = clockTime(clock.t, span);
    speed.value = clock.speed;
    slow.checked = clock.slow;
  });
  const around = events.length === 0 ? [] : [jump("Event before", kBefore, -1), jump("Next event", kNext, 1)];
  return element("div", {class: "transport", role: "group", "aria-label": "Playback"},
                 element("div", {class: "track"}, slider, marks),
                 element("div", {class: "buttons"}, play, ...around, readout, element("span", {class: "room"}), speed,
                         events.length === 0 ? undefined : element("label", {title: "Slow motion near events"}, slow, "slow near events")));
}

/// What a key does to a record; true where it did something.
export function pressKey(event, clock, record) {
  const step = ((clock.end - clock.start) / 600) * (event.shiftKey ? 10 : 1);
  const faster = (way) => kSpeeds[Math.min(kSpeeds.length - 1, Math.max(0, kSpeeds.indexOf(clock.speed) + way))];
  const actions = {
    " ": () => clock.toggle(),
    ArrowLeft: () => clock.go(clock.t - step),
    ArrowRight: () => clock.go(clock.t + step),
    Home: () => clock.go(clock.start),
    End: () => clock.go(clock.end),
    n: () => clock.jump(1),
    p: () => clock.jump(-1),
    "[": () => clock.setSpeed(faster(-1)),
    "]": () => clock.setSpeed(faster(1)),
    s: () => clock.setSlow(!clock.slow),
    f: () => record.animation?.fit(),
    z: () => record.plots.zoomOut(),
  };
  const action = actions[event.key] ?? actions[event.key.toLowerCase()];
  action?.();
  return action !== undefined;
}
