#!/bin/bash
# Tests the bundle on bare systems that debootstrap makes from this machine's mirror:
#   tests/bundle.sh BUILD [FOLDER [RELEASE...]]
# Run as root; takes some minutes and 2 GB in FOLDER (default: a temporary one). Default releases: bookworm and
# trixie. With and without /sys, the picture must equal the picture of the build's own program on PoCL, and
# `check` must find no fault.
set -eu
build=$(readlink -f -- "$1")
folder=${2:-$(mktemp -d)}
releases=("${@:3}")
[[ ${#releases[@]} -gt 0 ]] || releases=(bookworm trixie)
command -v debootstrap >/dev/null || { echo "bundle: no debootstrap here. On Debian: apt-get install debootstrap" >&2; exit 1; }
archive=$(ls "$build"/sundog-*-linux-x86_64.tar.zst)
name=$(basename -- "$archive" .tar.zst)
mirror=$(sed -n 's/^URIs: *\([^ ]*\).*/\1/p; s/^deb \(\[[^]]*\] \)\?\([^ ]*\) .*/\2/p' /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null | head -1)
picture=(--size 160x120 --device pocl -q)
mkdir -p "$folder"
"$build/sundog" render "${BASH_SOURCE[0]%/*}/../scenes/spheres.json" "${picture[@]}" -o "$folder/expected.png"
for release in "${releases[@]}"; do
  root=$folder/$release
  [[ -d $root ]] || debootstrap --variant=minbase "$release" "$root" "$mirror" >"$folder/$release.log" || { tail "$folder/$release.log" >&2; exit 1; }
  tar -C "$root/opt" --zstd -xf "$archive"
  trap 'umount "$root/sys" "$root/proc" 2>/dev/null || true' EXIT
  mount -t proc proc "$root/proc"
  for sys in without with; do
    [[ $sys == without ]] || mount -t sysfs sysfs "$root/sys"
    rm -rf "$root/srv/.cache"
    chroot "$root" env -i HOME=/srv PATH=/usr/bin:/bin "/opt/$name/sundog" render "/opt/$name/scenes/spheres.json" "${picture[@]}" -o /picture.png
    cmp "$folder/expected.png" "$root/picture.png"
    echo "bundle: $release $sys /sys: the same picture"
  done
  chroot "$root" env -i HOME=/srv PATH=/usr/bin:/bin "/opt/$name/sundog" check
  umount "$root/sys" "$root/proc"
done
