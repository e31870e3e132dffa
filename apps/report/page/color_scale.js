// One colour for one number: a scale from dark blue over green to yellow, equal steps of which look equally far apart, in light and dark.

// Anchor colours (sRGB) at even distances; between them the colour is mixed linearly.
const kAnchors = [[42, 34, 98], [46, 83, 140], [36, 124, 142], [53, 163, 125], [132, 198, 87], [236, 221, 72]];

/// [r, g, b] of a share in [0, 1].
export function scaleColor(share) {
  const place = Math.min(1, Math.max(0, share)) * (kAnchors.length - 1), k = Math.min(kAnchors.length - 2, Math.floor(place)), f = place - k;
  return kAnchors[k].map((from, i) => Math.round(from + f * (kAnchors[k + 1][i] - from)));
}

export function cssColor(share) {
  return `rgb(${scaleColor(share).join(" ")})`;
}

export function cssGradient() {
  return `linear-gradient(to right, ${kAnchors.map((_, k) => cssColor(k / (kAnchors.length - 1))).join(", ")})`;
}
