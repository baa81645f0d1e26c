#!/bin/sh
# Installs the Debian 12 packages that skyhalo needs and that are missing. Usage: setup_debian.sh [build|test]
# "build" is enough to build and run the program, "test" adds what the tests use. Says what it does; does
# nothing, and asks no server, when nothing is missing. SKYHALO_SKIP_SETUP=1 turns it off.
set -eu

build_packages="
  cmake g++ ninja-build python3
  libassimp-dev libcli11-dev libeigen3-dev libembree-dev libhwy-dev liboctomap-dev libopencv-dev libtbb-dev libyaml-cpp-dev libzstd-dev
  nlohmann-json3-dev zlib1g-dev"
test_packages="
  clang-14 clang-format-14 clang-tidy-14 libclang-rt-14-dev python3-jsonschema python3-yaml
  g++-aarch64-linux-gnu libbenchmark-dev libgmock-dev libgtest-dev
  octomap-tools pcl-tools qemu-user"

case "${1:-test}" in
  build) wanted=$build_packages ;;
  test) wanted="$build_packages $test_packages" ;;
  *) echo "usage: $0 [build|test]" >&2; exit 2 ;;
esac

if [ "${SKYHALO_SKIP_SETUP:-0}" = 1 ]; then
  echo "setup: skipped (SKYHALO_SKIP_SETUP=1)"
  exit 0
fi
if ! command -v dpkg-query >/dev/null; then
  echo "setup: this is no Debian system; install what corresponds to:" $wanted >&2
  echo "setup: then set SKYHALO_SKIP_SETUP=1" >&2
  exit 1
fi

if [ "$(id -u)" = 0 ]; then
  as_root=
elif command -v sudo >/dev/null; then
  as_root=sudo
else
  as_root=none
fi

require_root() {
  if [ "$as_root" = none ]; then
    echo "setup: run this as root, or install sudo; missing: $*" >&2
    exit 1
  fi
}

missing=
for package in $wanted; do
  state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  case $state in installed*) ;; *) missing="$missing $package" ;; esac
done
if [ -z "$missing" ]; then
  echo "setup: all packages are installed"
  exit 0
fi

require_root $missing
echo "setup: installing$missing"
$as_root apt-get update -qq
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
echo "setup: done"
