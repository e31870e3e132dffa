// Building the document: every text goes in as text, never as markup.

/// element("button", {class: "x", "aria-label": "y", onclick: f}, child, "text", ...)
export function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (value !== undefined && value !== false) node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.filter((child) => child !== undefined && child !== null));
  return node;
}

export function download(name, text, type = "text/csv") {
  const url = URL.createObjectURL(new Blob([text], {type}));
  element("a", {href: url, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

/// Calls `make` once `node` is about to be seen, so that a long page opens at once; printing shows everything.
const waiting = new Map();
const kMargin = 300;  // pixels beyond the window
const observer = new IntersectionObserver((entries) => {
  for (const entry of entries) if (entry.isIntersecting) show(entry.target);
}, {rootMargin: `${kMargin}px`});

function show(node) {
  const make = waiting.get(node);
  waiting.delete(node);
  observer.unobserve(node);
  make?.();
}

export function whenSeen(node, make) {
  waiting.set(node, make);
  observer.observe(node);
}

/// What the window holds right now, so that the page's first picture is whole.
export function showNear() {
  for (const node of [...waiting.keys()]) {
    const {top, bottom} = node.getBoundingClientRect();
    if (bottom > -kMargin && top < window.innerHeight + kMargin) show(node);
  }
}

export function showAll() {
  for (const node of [...waiting.keys()]) show(node);
}

window.addEventListener("beforeprint", showAll);
