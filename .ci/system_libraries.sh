#!/bin/sh
# Installs the Debian/Ubuntu packages that slamgym needs, if any is missing: EGL and Mesa for rendering, X11 libraries
# for ORB-SLAM3, what the Python named by the first argument lacks to make a virtual environment, and the packages that
# the other arguments name.
set -eu

packages="libegl1 libgl1 libopengl0 libglx0 libgl1-mesa-dri libegl-mesa0 libsm6 libice6 libx11-6 libxext6"
python=${1:-python3}
[ $# -eq 0 ] || shift
packages="$packages $*"

if ! command -v dpkg-query >/dev/null 2>&1; then
    echo "note: not a Debian or Ubuntu system; slamgym needs your system's packages for EGL, OpenGL, Mesa and X11" >&2
    exit 0
fi

version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])')
"$python" -c 'import ensurepip' 2>/dev/null || packages="$packages python$version-venv"
# pybullet has wheels for Python 3.11; for a later one pip compiles it.
if [ "$version" != 3.11 ]; then
    command -v g++ >/dev/null || packages="$packages g++"
    "$python" -c 'import os, sys, sysconfig; sys.exit(not os.path.exists(sysconfig.get_path("include") + "/Python.h"))' ||
        packages="$packages python$version-dev"
fi

missing=""
for package in $packages; do
    # One line an architecture, where a machine has several.
    dpkg-query -W -f '${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

if [ "$(id -u)" = 0 ]; then
    sudo=""
elif command -v sudo >/dev/null 2>&1 && sudo -n true 2>/dev/null; then
    sudo="sudo"
else
    echo "missing system packages; install them and try again:" >&2
    echo "    sudo apt-get update && sudo apt-get install -y --no-install-recommends$missing" >&2
    exit 1
fi
echo "installing system packages:$missing"
export DEBIAN_FRONTEND=noninteractive
$sudo apt-get update -qq
# shellcheck disable=SC2086
$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
