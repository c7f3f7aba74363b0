#!/bin/bash
# Makes the Debian packages of a build folder, checks them with lintian, and installs and runs them on a bare
# system that debootstrap makes from this machine's release and mirrors:
#   tests/package.sh BUILD [FOLDER]
# Run as root; takes some minutes and 1 GB in FOLDER (default: a temporary one). Everything must be built in
# BUILD.
set -eu
build=$(readlink -f -- "$1")
folder=${2:-$(mktemp -d)}
for tool in cpack lintian debootstrap; do
  command -v "$tool" >/dev/null || { echo "package: no $tool here. On Debian: apt-get install cmake lintian debootstrap" >&2; exit 1; }
done
mkdir -p "$folder"
(cd "$build" && cpack -B "$folder/packages" >"$folder/cpack.log") || { cat "$folder/cpack.log" >&2; exit 1; }
lintian --fail-on error,warning "$folder"/packages/*.deb

root=$folder/root
. /etc/os-release
mirror=$(sed -n 's/^URIs: *\([^ ]*\).*/\1/p; s/^deb \(\[[^]]*\] \)\?\([^ ]*\) .*/\2/p' /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null | head -1)
debootstrap --variant=minbase "$VERSION_CODENAME" "$root" "$mirror" >"$folder/debootstrap.log" || { tail "$folder/debootstrap.log" >&2; exit 1; }
rm -f "$root/etc/apt/sources.list"
cp -r /etc/apt/sources.list* /etc/apt/apt.conf.d "$root/etc/apt/" 2>/dev/null || true
cp /etc/resolv.conf "$root/etc/"
mkdir -p "$root/packages"
cp "$folder"/packages/{sundog_,libsundog}*.deb "$root/packages/"
trap 'umount "$root/proc" 2>/dev/null || true' EXIT
mount -t proc proc "$root/proc"
in_root() { chroot "$root" env DEBIAN_FRONTEND=noninteractive HOME=/root "$@"; }
in_root apt-get update -qq
in_root sh -c 'apt-get install -y -qq --no-install-recommends /packages/*.deb pocl-opencl-icd >/install.log 2>&1 || { tail /install.log; exit 1; }'
in_root sundog render /usr/share/sundog/scenes/spheres.json --size 160x120 -o /picture.png
in_root test -e /usr/share/bash-completion/completions/sundog -a -e /usr/lib/libsundog.so.0.1 -a -e /usr/include/sundog/sundog.hpp
in_root sh -c 'ldd /usr/lib/libsundog.so.0.1 | grep "not found"' && exit 1
in_root apt-get purge -y -qq sundog libsundog-dev 'libsundog0.*' >/dev/null
if in_root test -e /usr/bin/sundog; then echo "package: the program is still there after a purge" >&2; exit 1; fi
echo "package: installed, run and removed on a bare $VERSION_CODENAME; the picture is $root/picture.png"
