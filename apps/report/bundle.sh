#!/usr/bin/env bash
# Makes bundle/page.html from page/*: our own modules with uPlot and three.js, whose versions stand in page/package.json.
# Needs node and npm; whoever only builds tenon needs neither, for the bundle is part of the tree.
set -euo pipefail
cd "$(dirname "$0")"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp page/* "$work"
(cd "$work" && npm install --no-package-lock --no-audit --no-fund --silent)

mkdir -p bundle
output=$PWD/bundle/page.html
(cd "$work" && node bundle.mjs "$output")
cp "$work/node_modules/uplot/LICENSE" bundle/LICENSE.uplot
cp "$work/node_modules/three/LICENSE" bundle/LICENSE.three
