#!/usr/bin/env bash
# Makes the README's pictures in apps/report/gallery from real runs of the program that is built; installs chromium where it is missing.
#
#   apps/report/gallery.sh [NAME ...]       all pictures, or those named
#
# To add one: a line at the end, `picture NAME WIDTHxHEIGHT 'PLACE IN THE PAGE' VERB ...`, where the place is a time and a theme.
source "$(dirname "$0")/../setup.sh"

install_packages "${test_packages[@]}"
tenon=build/release/tenon
pictures=apps/report/gallery
pages=build/gallery
mkdir -p "$pages" "$pictures"
wanted=" $* "

# picture NAME WIDTHxHEIGHT PLACE VERB ARGUMENTS...: runs `tenon VERB ARGUMENTS... --report`, and looks at the page.
picture() {
  local name=$1 size=$2 place=$3 page=$pages/$1.html profile
  shift 3
  if [[ $wanted != "  " && $wanted != *" $name "* ]]; then return; fi
  "$tenon" "$@" --report "$page" --quiet > /dev/null
  profile=$(mktemp -d)
  chromium --headless --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader --hide-scrollbars --user-data-dir="$profile" \
    --window-size="${size/x/,}" --virtual-time-budget=6000 --screenshot="$pictures/$name.png" "file://$PWD/$page#$place" 2> /dev/null
  rm -rf "$profile"
  echo "$pictures/$name.png: tenon $*"
}

sweep=problems/allocation/hover_sweep.csv
classic=(hs001 hs006 hs012 hs021 hs028 hs035 hs039 hs040 hs043 hs044 hs065 hs071 hs076 hs093 hs100 hs106 hs113)

picture hover 1280x800 't=12&theme=light' allocate momav --wrenches $sweep
picture rotor_failure 1280x800 't=21&theme=dark' allocate momav --wrenches $sweep --set rotor.3.fails_at=20
picture cradle 1280x800 't=2.3&theme=light' simulate cradle
picture car 1280x800 't=1.03&theme=dark' simulate car
picture compare 1280x800 'theme=light' compare "${classic[@]}"
picture convergence 1280x800 'theme=light' solve hs106
picture envelope 1280x560 'theme=light' envelope momav
picture peg_in_hole 1280x900 't=0.26&theme=light' mpc peg-in-hole-delta --seed 2
picture soft_walls 1280x900 't=0.2&theme=dark' mpc cart-pole-soft-walls
picture sweep 1280x1000 'theme=light' sweep peg-in-hole-tight --samples 200 --baselines
