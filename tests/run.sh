#!/usr/bin/env bash
# Sets up, builds and runs the test suite, but for the cases labelled `long`; the last lines are CTest's own.
#
#   tests/run.sh [PRESET [CTEST ARGUMENTS]]       PRESET: release (default), dev or asan, as in CMakePresets.json
#
#   tests/run.sh asan                             the suite under the address and undefined-behaviour sanitizers
#   tests/run.sh release -R newton                the cases whose names match
#   ctest --preset release -L long                the long ones, afterwards
source "$(dirname "$0")/../apps/setup.sh"

preset=${1:-release}
install_packages "${test_packages[@]}"
configure "$preset"
build "$preset"
ctest --preset "$preset" --label-exclude long "${@:2}"
