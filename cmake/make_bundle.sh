#!/bin/bash
# Makes a bundle (docs/guide/bundle.md): make_bundle.sh PROGRAM FILE.tar.zst. If FILE's name ends in "-slim",
# the bundle lacks PoCL, its compiler and its linker. It contains this system's libraries and their
# copyrights.
set -eu
program=$1 archive=$2
root=$(readlink -f -- "${BASH_SOURCE[0]%/*}/..")
name=${archive##*/}
name=${name%.tar.zst}
folder=${archive%/*}/bundle/$name
lib=$folder/lib/x86_64-linux-gnu
say() { echo "bundle: $*" >&2; }
for tool in zstd tar dpkg-query patchelf; do command -v "$tool" >/dev/null || { say "no $tool here: apt-get install $tool"; exit 1; }; done

# Libraries that the machine's drivers may bring or need too: the machine's own copies take precedence
# (cmake/bundle/sundog).
common='^(libstdc\+\+|libgcc_s|libz|libzstd|libffi|libtinfo|libxml2|liblzma|libedit|libbsd|libmd|libudev|libcap|libelf)\.'
# Libraries of glibc, which the machine must have (2.36 or newer).
glibc='^(ld-linux-x86-64|libc|libm|libdl|libpthread|librt)\.so'

libraries_of() { ldd "$@" | sed -n 's/^\t\([^ ]*\) => \(\/[^ ]*\) .*/\1 \2/p' | sort -u; }
taken=()
take_library() {  # NAME FILE
  local to=$lib
  [[ $1 =~ $glibc ]] && return
  [[ $1 =~ $common ]] && to=$lib/common/${1%%.so*}
  mkdir -p "$to"
  local real
  real=$(readlink -f -- "$2")
  [[ -e $to/$1 ]] || { cp "$real" "$to/" && { [[ ${real##*/} == "$1" ]] || ln -s "${real##*/}" "$to/$1"; }; }
  taken+=("$2" "$real")
}
take_libraries_of() { while read -r library file; do take_library "$library" "$file"; done < <(libraries_of "$@"); }

rm -rf "$folder"
mkdir -p "$folder"/{bin,share/doc} "$lib"
cp "$program" "$folder/bin/"
take_libraries_of "$program"
cp "$root/cmake/bundle/sundog" "$folder/"
cp -r "$root/scenes" "$folder/"
mkdir -p "$folder/bench"
cp "$root/bench/gpu.sh" "$folder/bench/"
cp "$root"/{LICENSE,NOTICE,README.md,CHANGELOG.md} "$folder/share/doc/"
cp "$root/docs/guide/bundle.md" "$folder/README.md"

# PoCL's picture of every scene in 64x64, for bench/gpu.sh; rendered once per program. BUNDLE_PICTURES=none:
# none.
pictures=${archive%/*}/bundle/pictures
if [[ ${BUNDLE_PICTURES-} != none ]]; then
  mkdir -p "$pictures"
  for scene in "$root"/scenes/*.json; do
    picture=$pictures/$(basename -- "$scene" .json).png
    [[ $scene == *scene.schema.json || $picture -nt $program ]] || "$program" render "$scene" --device pocl --size 64x64 -q -o "$picture"
  done
  cp -r "$pictures" "$folder/"
fi

if [[ $name != *-slim ]]; then
  pocl=$(ldconfig -p | sed -n 's/.*libpocl\.so\.[0-9]* .*=> //p' | head -1)
  [[ -n $pocl ]] || { say "no libpocl here: apt-get install pocl-opencl-icd, or make bundle-slim"; exit 1; }
  mkdir -p "$folder"/{libexec,share}
  take_library "$(basename "$pocl")" "$pocl"
  take_libraries_of "$pocl"
  cp -r "${pocl%/*}/pocl" "$lib/"
  take_libraries_of "$lib"/pocl/*.so
  cp -r /usr/share/pocl "$folder/share/"
  mkdir -p "$folder/drivers/nvidia"
  basename "$pocl" >"$folder/drivers/pocl.icd"
  ln -s ../pocl.icd "$folder/drivers/nvidia/"
  echo libnvidia-opencl.so.1 >"$folder/drivers/nvidia/nvidia.icd"
  linker=$(readlink -f -- "$(command -v ld.bfd)")
  cp "$linker" "$folder/libexec/ld.bfd"
  cp "$root/cmake/bundle/ld" "$folder/libexec/"
  take_libraries_of "$linker"
  taken+=("$linker")
fi
# The copyrights of the copied files, by package.
dpkg-query -S "${taken[@]}" "${taken[@]/#\/lib\///usr/lib/}" 2>/dev/null | sed 's/:.*//' | sort -u | while read -r package; do
  cp "/usr/share/doc/$package/copyright" "$folder/share/doc/$package.txt"
done
# The program finds its libraries, and those of the drivers that it loads, beside it; the libraries' own
# search paths are removed.
find "$folder/bin" "$lib" -type f \( -perm -100 -o -name '*.so*' \) -exec strip --strip-unneeded {} + -exec patchelf --remove-rpath {} +
patchelf --force-rpath --set-rpath '$ORIGIN/../lib/x86_64-linux-gnu' "$folder/bin/sundog"

tar -C "${folder%/*}" --sort=name --owner=0 --group=0 --mtime=@0 -c "$name" | zstd -q -f -T0 "-${BUNDLE_LEVEL:-12}" -o "$archive"
say "$archive: $(($(stat -c %s "$archive") / 1000000)) MB, unpacked $(du -sm "$folder" | cut -f1) MB"
