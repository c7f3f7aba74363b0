#!/bin/bash
# Tests both bundles on bare systems that debootstrap makes from this machine's mirror:
#   tests/bundle.sh BUILD [FOLDER [RELEASE...]]
# Run as root; takes a quarter of an hour and 4 GB in FOLDER (default: a temporary one). Default releases:
# bookworm and trixie. With and without /sys, the bundle's picture must equal that of the build's own program on
# PoCL, `check` must find no fault, and bench/gpu.sh must run all its parts. The slim bundle must say that it has
# no driver, and draw the picture once the system has its own PoCL.
set -eu
build=$(readlink -f -- "$1")
folder=${2:-$(mktemp -d)}
releases=("${@:3}")
[[ ${#releases[@]} -gt 0 ]] || releases=(bookworm trixie)
command -v debootstrap >/dev/null || { echo "bundle: no debootstrap here. On Debian: apt-get install debootstrap" >&2; exit 1; }
slim_archive=$(ls "$build"/sundog-*-linux-x86_64-slim.tar.zst)
archive=${slim_archive/-slim.tar.zst/.tar.zst}
full=/opt/$(basename -- "$archive" .tar.zst) slim=/opt/$(basename -- "$slim_archive" .tar.zst)
mirror=$(sed -n 's/^URIs: *\([^ ]*\).*/\1/p; s/^deb \(\[[^]]*\] \)\?\([^ ]*\) .*/\2/p' /etc/apt/sources.list /etc/apt/sources.list.d/* 2>/dev/null | head -1)
picture=(scenes/spheres.json --size 160x120 --device pocl -q -o /picture.png)
fail() { echo "bundle: $release: $*" >&2; exit 1; }
say() { echo "bundle: $release, $(date -u +%H:%M): $*"; }

# in_root ROOT BUNDLE PROGRAM ARGUMENT...: runs a bundle's program in its folder, without variables.
in_root() { chroot "$1" env -i HOME=/srv PATH=/usr/bin:/bin sh -c 'cd "$0" && "$@"' "${@:2}"; }
draws() {  # ROOT BUNDLE WHERE
  rm -rf "$1/srv/.cache" "$1/picture.png"
  in_root "$1" "$2" ./sundog render "${picture[@]}"
  cmp "$folder/expected.png" "$1/picture.png"
  say "${2##*/} $3: the same picture"
}
leave() { umount "$folder"/*/sys "$folder"/*/proc 2>/dev/null || true; }
trap leave EXIT

mkdir -p "$folder"
(cd "${BASH_SOURCE[0]%/*}/.." && "$build/sundog" render "${picture[@]/#\/picture/$folder/expected}")
for release in "${releases[@]}"; do
  bare=$folder/$release drivers=$folder/$release-drivers
  [[ -d $bare ]] || debootstrap --variant=minbase "$release" "$bare" "$mirror" >"$folder/$release.log" || { tail "$folder/$release.log" >&2; exit 1; }
  if chroot "$bare" sh -c 'command -v ld'; then fail "has a linker, wanted a bare system"; fi
  rm -rf "$bare"/opt/*
  for each in "$archive" "$slim_archive"; do tar -C "$bare/opt" --zstd -xf "$each"; done
  rm -rf "$drivers"
  cp -a "$bare" "$drivers"
  for root in "$bare" "$drivers"; do mount -t proc proc "$root/proc"; done

  for sys in without with; do
    [[ $sys == without ]] || mount -t sysfs sysfs "$bare/sys"
    draws "$bare" "$full" "$sys /sys"
    in_root "$bare" "$full" ./sundog check
  done
  in_root "$bare" "$full" bench/gpu.sh --device pocl --quick --seconds 1800 /results
  say "${full##*/}: gpu.sh ran all its parts"

  in_root "$bare" "$slim" ./sundog info scenes/spheres.json >/dev/null
  if in_root "$bare" "$slim" ./sundog render "${picture[@]}" 2>"$folder/slim.log"; then fail "the slim bundle has a device"; fi
  grep -q 'there is no OpenCL platform: install one' "$folder/slim.log" || fail "the slim bundle: $(cat "$folder/slim.log")"
  say "${slim##*/}: $(cat "$folder/slim.log")"

  cp /etc/resolv.conf "$drivers/etc/"
  chroot "$drivers" sh -c 'export DEBIAN_FRONTEND=noninteractive; apt-get update && apt-get install -y --no-install-recommends pocl-opencl-icd' \
    >"$folder/$release-drivers.log" 2>&1 || { tail "$folder/$release-drivers.log" >&2; exit 1; }
  for bundle in "$full" "$slim"; do
    draws "$drivers" "$bundle" "with the system's PoCL"
    [[ $(in_root "$drivers" "$bundle" ./sundog devices | grep -c '^[0-9]') == 1 ]] || fail "${bundle##*/}: wanted the system's PoCL alone"
  done
  leave
done
ls -l --block-size=1 "$archive" "$slim_archive"
