# What demo.sh and tests/run.sh share; sourced by both. Leaves the shell in the project's folder, with three verbs:
#
#   install_packages [PACKAGE ...]   installs the Debian packages that are missing, these too, and asks the network only then
#   configure PRESET      one of CMakePresets.json
#   build PRESET [...]    on all cores that memory allows; further words go to `cmake --build`
#
# The only list of packages stands here.

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

packages=(
  g++ cmake ninja-build ccache pkg-config
  libeigen3-dev libfmt-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev
  coinor-libipopt-dev libnlopt-dev libsundials-dev libsuitesparse-dev libamplsolver-dev
  libgtest-dev libgmock-dev libbenchmark-dev
  libopenmpi-dev openmpi-bin
)
test_packages=(chromium)  # opens the report page

install_packages() {
  if ! command -v apt-get dpkg-query > /dev/null; then
    echo "This is not a Debian system; going on in the hope that it has the like of: ${packages[*]}" >&2
    return
  fi
  local missing=() package as_root=()
  for package in "${packages[@]}" "$@"; do
    dpkg-query --show --showformat '${db:Status-Status}\n' "$package" 2> /dev/null | grep -qx installed || missing+=("$package")
  done
  if ((${#missing[@]} == 0)); then return; fi

  echo "Missing Debian packages: ${missing[*]}"
  if ((EUID != 0)); then as_root=(sudo); fi
  "${as_root[@]}" apt-get update --quiet || echo "apt-get update had errors; trying with the lists at hand" >&2
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install --quiet --yes --no-install-recommends -o DPkg::Lock::Timeout=300 "${missing[@]}"
}

configure() {
  cmake --preset "$1"
}

build() {
  local preset=$1 cores gigabytes jobs
  shift
  cores=$(nproc)
  gigabytes=$(awk '/^MemAvailable:/ { print int($2 / 1048576) }' /proc/meminfo)
  jobs=$((gigabytes / 2 < cores ? gigabytes / 2 : cores))  # a heavy translation unit of templates takes up to 2 GB
  cmake --build --preset "$preset" --parallel $((jobs < 1 ? 1 : jobs)) "$@"
}
