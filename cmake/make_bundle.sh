#!/bin/bash
# Makes a bundle (docs/guide/bundle.md): make_bundle.sh PROGRAM FILE.tar.zst. If FILE's name ends in "-slim",
# the bundle lacks PoCL, its compiler and its linker. It contains this system's libraries and their
# copyrights. Fails if the bundle is too large, or if it needs a newer glibc than the page promises. Variables:
#   BUNDLE_TINYBVH=CHECKOUT    add the tinybvh_rays beside PROGRAM, and the checkout's kernels
#   BUNDLE_PICTURES=NAMES      add pictures of these scenes only, or `none`
#   BUNDLE_LEVEL, BUNDLE_MEGABYTES, BUNDLE_GLIBC    level of compression; the most that is allowed
set -eu
program=$1 archive=$2
root=$(readlink -f -- "${BASH_SOURCE[0]%/*}/..")
name=${archive##*/}
name=${name%.tar.zst}
folder=${archive%/*}/bundle/$name
lib=$folder/lib/x86_64-linux-gnu
most_megabytes=100 most_glibc=${BUNDLE_GLIBC:-2.36}
[[ $name == *-slim ]] && most_megabytes=15
most_megabytes=${BUNDLE_MEGABYTES:-$most_megabytes}
say() { echo "bundle: $*" >&2; }
for tool in zstd tar dpkg-query patchelf objdump; do
  command -v "$tool" >/dev/null || { say "no $tool here: apt-get install binutils patchelf zstd"; exit 1; }
done

# Libraries that the machine's drivers may bring or need too: the machine's own copies take precedence
# (cmake/bundle/sundog).
common='^(libstdc\+\+|libgcc_s|libz|libzstd|libffi|libtinfo|libxml2|liblzma|libedit|libbsd|libmd|libudev|libcap|libelf)\.'
# Libraries of glibc, which the machine must have.
glibc='^(ld-linux-x86-64|libc|libm|libdl|libpthread|librt)\.so'

libraries_of() { ldd "$@" | sed -n 's/^\t\([^ ]*\) => \(\/[^ ]*\) .*/\1 \2/p' | sort -u; }
taken=()
take_library() {  # NAME FILE
  local to=$lib
  [[ $1 =~ $glibc ]] && return
  [[ $1 =~ $common ]] && to=$lib/common/$1
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
cp -r "$root"/{scenes,examples} "$folder/"
mkdir -p "$folder/bench"
cp "$root/bench/gpu.sh" "$folder/bench/"
cp "$root"/{LICENSE,NOTICE,README.md,CHANGELOG.md} "$folder/share/doc/"
cp "$root/docs/guide/bundle.md" "$folder/README.md"

if [[ ${BUNDLE_TINYBVH-} && -x ${program%/*}/tinybvh_rays ]]; then
  cp "${program%/*}/tinybvh_rays" "$folder/bin/"
  take_libraries_of "$folder/bin/tinybvh_rays"
  ln -s sundog "$folder/tinybvh_rays"
  mkdir "$folder/tinybvh"
  cp -r "$BUNDLE_TINYBVH/kernels" "$folder/tinybvh/"
  cp "$BUNDLE_TINYBVH/LICENSE" "$folder/share/doc/tinybvh.txt"
fi

# PoCL's picture of every scene in 64x64, for bench/gpu.sh; rendered once per program.
pictures=${archive%/*}/bundle/pictures
mkdir -p "$pictures" "$folder/pictures"
for scene in "$root"/scenes/*.json; do
  scene_name=$(basename -- "$scene" .json)
  picture=$pictures/$scene_name.png
  [[ $scene_name == scene.schema || " ${BUNDLE_PICTURES:-$scene_name} " != *" $scene_name "* ]] && continue
  [[ $picture -nt $program ]] || "$program" render "$scene" --device pocl --size 64x64 -q -o "$picture"
  cp "$picture" "$folder/pictures/"
done

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
for file in "$folder"/bin/*; do patchelf --force-rpath --set-rpath '$ORIGIN/../lib/x86_64-linux-gnu' "$file"; done

newest() { printf '%s\n' "$@" | sort -V | tail -n 1; }
needed=$(find "$folder" -type f \( -perm -100 -o -name '*.so*' \) | while read -r file; do
  objdump -p "$file" 2>/dev/null | sed -n "s|.* GLIBC_\([0-9.]*\)\$|\1 in ${file#"$folder"/}|p"
done | sort -V | tail -n 1)
if [[ $(newest "$most_glibc" "${needed%% *}") != "$most_glibc" ]]; then
  say "needs glibc $needed, wanted $most_glibc or older: make the bundle on Debian 12"
  exit 1
fi

tar -C "${folder%/*}" --sort=name --owner=0 --group=0 --mtime=@0 -c "$name" | zstd -q -f -T0 "-${BUNDLE_LEVEL:-12}" -o "$archive"
bytes=$(stat -c %s "$archive")
say "$archive: $((bytes / 1000000)) MB, unpacked $(du -sm "$folder" | cut -f1) MB, glibc ${needed%% *}"
if ((bytes > most_megabytes * 1000000)); then
  say "larger than $most_megabytes MB. The largest files: $(cd "$folder" && find . -type f -printf '%s %P\n' | sort -rn | head -n 3 | tr '\n' ' ')"
  rm "$archive"
  exit 1
fi
