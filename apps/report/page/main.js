// The page: reads the data it carries, makes one section for each part, and listens to the keys.
import "uplot/dist/uPlot.min.css";
import "./page.css";
import {Comparison, Profile} from "./comparison.js";
import {Convergence} from "./convergence.js";
import {element, showAll, showNear} from "./element.js";
import {FrequencyResponse} from "./frequency.js";
import {Record} from "./record.js";
import {SphereMap} from "./sphere_map.js";
import {Sweep} from "./sweep.js";
import {toggleTheme} from "./theme.js";
import {kKeys, pressKey} from "./transport.js";

const kParts = {trajectory: Record, trace: Convergence, comparison: Comparison, profile: Profile, frequency: FrequencyResponse, sphere: SphereMap, sweep: Sweep};

function makeHelp() {
  const help = element("dialog", {"aria-label": "Keys"}, element("h2", {}, "Keys"),
                       element("dl", {}, ...kKeys.flatMap(([keys, does]) => [element("dt", {}, keys), element("dd", {}, does)])),
                       element("form", {method: "dialog"}, element("button", {}, "close")));
  document.body.append(help);
  return help;
}

/// The record that keys go to: the one that takes most of the window.
function recordInView(parts) {
  const seen = (part) => {
    const box = part.node.getBoundingClientRect();
    return Math.min(box.bottom, window.innerHeight) - Math.max(box.top, 0);
  };
  return parts.filter((part) => part.clock).sort((a, b) => seen(b) - seen(a))[0];
}

function listenToKeys(parts, help) {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || help.open) return;
    const target = event.target;
    if (target.matches?.("select, input[type=text]") || (event.key === " " && target.matches?.("button, summary, input[type=checkbox]"))) return;
    if (event.key === "?") help.showModal();
    else if (event.key.toLowerCase() === "t") toggleTheme();
    else {
      const record = recordInView(parts);
      if (!record || !pressKey(event, record.clock, record)) return;
    }
    event.preventDefault();
  });
}

/// #t=1.5 opens the page at that time.
function goToHash(parts) {
  const asked = /[#&]t=([-+.\deE]+)/.exec(location.hash);
  if (asked) for (const part of parts) part.clock?.go(Number(asked[1]));
}

function start() {
  const data = JSON.parse(document.getElementById("report-data").textContent);
  const main = document.getElementById("parts"), contents = document.getElementById("contents"), help = makeHelp();
  const parts = data.parts.map((part, index) => {
    const made = new kParts[part.kind](part, index);
    main.append(made.node);
    return made;
  });
  if (parts.length > 1) contents.append(...parts.map((part, index) => element("a", {href: "#part-" + index}, part.title)));
  document.getElementById("theme").addEventListener("click", toggleTheme);
  document.getElementById("help").addEventListener("click", () => help.showModal());
  listenToKeys(parts, help);
  goToHash(parts);
  showNear();
  window.addEventListener("hashchange", () => goToHash(parts));
  window.report = {parts, showAll};  // for the console, and for tests
  document.documentElement.dataset.ready = "true";
}

start();
