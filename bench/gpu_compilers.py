#!/usr/bin/env python3
"""Compiles the kernels of scenes with the GPU makers' compilers, without a GPU. Usage:

    bench/gpu_compilers.py [SUNDOG] [--scenes cornell_path,...] [--targets sm_90,gfx1100,...] [--table FILE] [options]

NVIDIA (sm_*)  clang and libclc make PTX; ptxas (PyPI nvidia-cuda-nvcc) assembles it
AMD (gfx*)     clang and libclc
Intel          ocloc (Debian's intel-opencl-icd), for dg2 and pvc

--fetch downloads what is missing, except clang (apt-get download, pip download), and unpacks it into --tools
without installing anything. A compiler's error or warning is a failure. The table has a row for each kernel
of each scene: registers; bytes of stack (scratch) and of spills per work-item (AMD: spilled registers); waves
that the registers admit (NVIDIA: warps of a multiprocessor, AMD: waves of a SIMD, Intel: lanes of the
kernel's SIMD); bytes of code (AMD: the program's); the compilers' seconds of processor time. If a compiler's
version is the same as in the last table, rows are compared with it: a kernel with fewer waves or more spills
(Intel: also with 256 registers instead of 128) is a failure, unless --keep writes the new table. Exit status
77: a compiler is missing.
"""
import argparse
import concurrent.futures
import csv
import glob
import hashlib
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FIGURES = ("registers", "stack", "spills", "waves", "code", "seconds")
COLUMNS = ("target", "scene", "kernel") + FIGURES
# Target: maker, clang's processor, and for NVIDIA the most warps of a multiprocessor.
TARGETS = {"sm_75": ("nvidia", "sm_75", 32), "sm_90": ("nvidia", "sm_90", 64), "sm_120": ("nvidia", "sm_90", 48),
           "gfx90a": ("amd", "gfx90a", 0), "gfx1030": ("amd", "gfx1030", 0), "gfx1100": ("amd", "gfx1100", 0),
           "gfx1201": ("amd", "gfx1201", 0), "dg2": ("intel", "dg2-g10", 0), "pvc": ("intel", "pvc", 0)}
# The Debian packages of each tool.
PACKAGES = {"clang": ["clang-19"], "libclc": ["libclc-19"],
            "ocloc": ["intel-opencl-icd", "libigc1", "libigdfcl1", "libigdgmm12", "libopencl-clang14", "libllvmspirvlib14"]}
NEEDS = {"nvidia": ("clang", "libclc", "ptxas"), "amd": ("clang", "libclc"), "intel": ("ocloc",)}


class CompilerError(Exception):
    pass


class Ended:
    """Runs a command to its end: status, output and processor seconds, which other load does not lengthen."""

    def __init__(self, command, **more):
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **more)
        self.stdout = process.stdout.read().decode(errors="replace")
        _, status, used = os.wait4(process.pid, 0)
        self.returncode = process.returncode = os.waitstatus_to_exitcode(status)
        self.seconds = used.ru_utime + used.ru_stime


class Tools:
    """The compilers, from the system or from the folder that --fetch fills."""

    def __init__(self, folder):
        self.folder = folder
        self.fetched = os.path.join(folder, "packages.txt")  # what fetch() unpacked
        self.libraries = os.path.join(folder, "usr/lib/x86_64-linux-gnu")
        self.clang = shutil.which("clang-19") or shutil.which("clang")
        self.libclc = next(filter(os.path.isdir, ("/usr/lib/clc", os.path.join(folder, "usr/lib/clc"))), None)
        self.ptxas = shutil.which("ptxas") or next(iter(glob.glob(os.path.join(folder, "nvidia/*/bin/ptxas"))), None)
        self.ocloc = shutil.which("ocloc") or next(iter(glob.glob(os.path.join(folder, "usr/bin/ocloc"))), None)

    def missing(self, maker):
        return [tool for tool in NEEDS[maker] if not getattr(self, tool)]

    def version(self, maker):
        """The version of the compiler behind the figures, for the table."""
        if maker == "nvidia":
            return "ptxas " + first_match(r"V([\d.]+)", Ended([self.ptxas, "--version"]).stdout) + ", " + self.version("amd")
        if maker == "amd":
            return f"clang {first_match(r'version ([0-9.]+)', Ended([self.clang, '--version']).stdout)}, {self.libclc_package()}"
        with tempfile.TemporaryDirectory() as here:  # ocloc writes its answer there
            Ended([self.ocloc, "query", "OCL_DRIVER_VERSION"], env=self.environment(), cwd=here)
            return "ocloc " + open(os.path.join(here, "OCL_DRIVER_VERSION")).read().strip("\0\n ")

    def libclc_package(self):
        """The Debian package of the library and its version, as distributions pair it with other versions of clang."""
        library = os.path.realpath(os.path.join(self.libclc, "amdgcn--amdhsa.bc"))
        if library.startswith(os.path.realpath(self.folder)):
            return first_match(r"^(libclc.*)$", open(self.fetched).read())
        if not shutil.which("dpkg"):
            return f"libclc of {os.path.getsize(library)} bytes"
        package = Ended(["dpkg", "-S", library]).stdout.partition(":")[0]
        return Ended(["dpkg-query", "-W", "-f", "${Package} ${Version}", package]).stdout

    def environment(self):
        found = os.environ.get("LD_LIBRARY_PATH", "")
        return dict(os.environ, LD_LIBRARY_PATH=":".join(filter(None, [self.libraries, found])))

    def fetch(self, makers):
        os.makedirs(self.folder, exist_ok=True)
        wanted = {tool for maker in makers for tool in self.missing(maker)}
        for tool in wanted - {"ptxas", "clang"}:
            with tempfile.TemporaryDirectory() as here:
                os.chmod(here, 0o755)
                got = Ended(["apt-get", "download", "-qq", *PACKAGES[tool]], cwd=here)
                packages = glob.glob(os.path.join(here, "*.deb"))
                if got.returncode != 0 or not packages:
                    print(f"gpu_compilers: {tool}: {got.stdout.strip()}", file=sys.stderr)
                for package in packages:
                    subprocess.run(["dpkg-deb", "-x", package, self.folder], check=True)
                    with open(self.fetched, "a") as out:
                        subprocess.run(["dpkg-deb", "-W", "--showformat=${Package} ${Version}\n", package], check=True, stdout=out)
        if "ptxas" in wanted:
            with tempfile.TemporaryDirectory() as here:
                got = Ended([sys.executable, "-m", "pip", "download", "-q", "--no-deps", "--only-binary", ":all:", "-d", here, "nvidia-cuda-nvcc"])
                for wheel in glob.glob(os.path.join(here, "*.whl")):
                    shutil.unpack_archive(wheel, self.folder, "zip")
                for program in glob.glob(os.path.join(self.folder, "nvidia/*/bin/ptxas")):
                    os.chmod(program, 0o755)
                if got.returncode != 0:
                    print(f"gpu_compilers: ptxas: {got.stdout.strip()}", file=sys.stderr)
        self.__init__(self.folder)


def mends(missing):
    packages = sorted({package for tool in missing for package in PACKAGES.get(tool, ["nvidia-cuda-nvcc (PyPI)"])})
    clang = "; clang: apt-get install clang-19" if "clang" in missing else ""
    return f"no {', '.join(missing)}: --fetch takes them from {', '.join(packages)}{clang}"


def first_match(pattern, text, group=1, otherwise="?"):
    found = re.search(pattern, text, re.M)
    return found.group(group) if found else otherwise


def checked(command, **more):
    """Runs a compiler and returns its Ended. Raises CompilerError for an error or a warning."""
    result = Ended(command, **more)
    wrong = [line for line in result.stdout.splitlines() if re.search(r"\b(error|warning|fatal)\b", line, re.I) and "spilled around" not in line]
    if result.returncode != 0 or wrong:
        raise CompilerError("\n".join(wrong[:5]) or f"{os.path.basename(command[0])}: exit status {result.returncode}: {result.stdout[-500:]}")
    return result


def sections(file):
    """The sections of a 64-bit ELF file: name -> bytes."""
    data = open(file, "rb").read()
    (at,), (size, count, names) = struct.unpack_from("<Q", data, 40), struct.unpack_from("<HHH", data, 58)
    heads = [struct.unpack_from("<IIQQQQ", data, at + i * size) for i in range(count)]
    text = data[heads[names][4]:]
    return {text[head[0]:text.index(b"\0", head[0])].decode(): data[head[4]:head[4] + head[5]] if head[1] != 8 else b"" for head in heads}


def clang_command(tools, target, triple, options, source):
    return [tools.clang, "-x", "cl", *[option for option in options if option.startswith(("-cl-std", "-D"))], "-target", triple, "-nogpulib",
            "-Xclang", "-finclude-default-header", "-Xclang", "-mlink-builtin-bitcode", "-Xclang", os.path.join(tools.libclc, f"{triple}.bc"),
            "-O3", "-S", source, "-Wall", "-Wextra", "-Wno-unused-parameter", "-Wno-unused-function", "-o", f"{source}.{target}.s"]


def by_nvidia(tools, target, options, source):
    _, processor, most_warps = TARGETS[target]
    made = checked(clang_command(tools, target, "nvptx64--nvidiacl", options, source)
                   + ["-Xclang", "-target-cpu", "-Xclang", processor, "-mllvm", "-nvptx-prec-divf32=1", "-mllvm", "-nvptx-prec-sqrtf32=0"])
    cap = [option.replace("-cl-nv-maxrregcount=", "-maxrregcount=") for option in options if option.startswith("-cl-nv-maxrregcount")]
    binary = f"{source}.{target}.cubin"
    assembled = checked([tools.ptxas, "-arch", target, "-v", *cap, f"{source}.{target}.s", "-o", binary])
    code = sections(binary)
    for part in re.split(r"Compiling entry function ", assembled.stdout)[1:]:
        name = first_match(r"'([^']+)'", part)
        registers = int(first_match(r"Used (\d+) registers", part))
        warps = 65536 // 4 // (-(-registers * 32 // 256) * 256) * 4
        stack = first_match(r"(\d+) bytes cumulative stack size", part, 1, first_match(r"(\d+) bytes stack frame", part))
        yield name, (registers, int(stack), sum(int(n) for n in re.findall(r"(\d+) bytes spill stores", part)), min(warps, most_warps),
                     len(code[f".text.{name}"]), made.seconds + assembled.seconds)


def by_amd(tools, target, options, source):
    made = checked(clang_command(tools, target, "amdgcn--amdhsa", options, source)
                   + [f"-mcpu={target}", "-Rpass-analysis=kernel-resource-usage"])
    assembly = open(f"{source}.{target}.s").read()
    whole = sum(int(size) for size in re.findall(r"codeLenInByte = (\d+)", assembly))
    for part in re.split(r"remark: +Function Name: ", made.stdout)[1:]:
        name = part.split()[0]
        value = lambda what: int(first_match(what + r"[^:]*: (\d+)", part))
        if f".amdhsa_kernel {name}\n" in assembly:
            yield name, (value("VGPRs") + (value("AGPRs") if target == "gfx90a" else 0), value("ScratchSize"), value("VGPRs Spill"),
                         value("Occupancy"), whole, made.seconds)


def by_intel(tools, target, options, source):
    out = f"{source}.{target}"
    used = " ".join(option for option in options if option.startswith(("-cl-std", "-cl-intel", "-D")))
    made = checked([tools.ocloc, "compile", "-file", source, "-device", TARGETS[target][1], "-options", used, "-internal_options",
                   "-cl-intel-allow-zebin", "-out_dir", out], env=tools.environment(), cwd=os.path.dirname(source))
    spilled = {name: int(count) for name, count in re.findall(r"kernel (\w+) +compiled SIMD\d+ allocated \d+ regs and spilled around (\d+)", made.stdout)}
    found = sections(glob.glob(os.path.join(out, "*.bin"))[0])
    for part in re.split(r"^  - name: +", found[".ze_info"].decode(errors="replace"), flags=re.M)[1:]:
        name = part.split()[0]
        if "simd_size" not in part or name.startswith("Intel_"):
            continue
        width = int(first_match(r"simd_size: +(\d+)", part))
        memory = re.findall(r"usage: +private_space\s+size: +(\d+)(\s+is_simt_thread: +true)?", part)
        private = sum(int(size) if of_lane else int(size) // width for size, of_lane in memory)
        yield name, (int(first_match(r"grf_count: +(\d+)", part)), private, spilled.get(name, 0), width, len(found[f".text.{name}"]), made.seconds)


COMPILERS = {"nvidia": by_nvidia, "amd": by_amd, "intel": by_intel}


def compiled(tools, target, options, source):
    """The kernels' figures, or a CompilerError."""
    try:
        return list(COMPILERS[TARGETS[target][0]](tools, target, options, source))
    except CompilerError as error:
        return error


def written_programs(sundog, scene, maker, folder):
    """Writes the scene's programs to the folder; yields (hash of text and options, file, options) of each."""
    listed = subprocess.run([sundog, "kernels", "--scene", os.path.join(ROOT, "scenes", f"{scene}.json"), "--gpu", maker, "--out", folder],
                            check=True, stdout=subprocess.PIPE, text=True).stdout
    for line in listed.splitlines():
        file, *options = line.split()
        text = open(file, "rb").read()
        yield hashlib.sha256(text + line.partition(" ")[2].encode()).hexdigest(), file, options


def read_table(file):
    if not os.path.exists(file):
        return {}, {}
    with open(file) as lines:
        versions = dict(re.findall(r"^# (\w+): (.*)$", lines.read(), re.M))
    with open(file) as lines:
        rows = csv.DictReader(line for line in lines if not line.startswith("#"))
        return versions, {(row["target"], row["scene"], row["kernel"]): tuple(float(row[name]) for name in FIGURES) for row in rows}


def write_table(file, versions, rows):
    with open(file, "w", newline="") as out:
        for target, version in sorted(versions.items()):
            out.write(f"# {target}: {version}\n")
        table = csv.writer(out, lineterminator="\n")
        table.writerow(COLUMNS)
        for key, figures in sorted(rows.items()):
            table.writerow((*key, *(f"{value:g}" for value in figures[:-1]), f"{figures[-1]:.1f}"))


def admitted(key, figures):
    """Waves that the registers admit. Intel's are lanes of a thread; one of 256 registers leaves room for half as many threads."""
    return figures["waves"] * (128 / figures["registers"] if TARGETS[key[0]][0] == "intel" else 1)


def differences(old, new):
    """Lines on rows with a change in waves, spills or stack: the losses, and the gains.

    >>> differences({("dg2", "s", "k"): (128, 0, 0, 16, 9, 1)}, {("dg2", "s", "k"): (256, 0, 0, 16, 9, 1)})
    (['dg2 s k: registers 128 -> 256'], [])
    >>> differences({("dg2", "s", "k"): (128, 0, 0, 8, 9, 1)}, {("dg2", "s", "k"): (256, 0, 0, 16, 9, 1)})
    ([], [])
    >>> differences({("sm_90", "s", "k"): (128, 8, 4, 16, 9, 1)}, {("sm_90", "s", "k"): (64, 8, 4, 32, 9, 1)})
    ([], ['sm_90 s k: registers 128 -> 64, waves 16 -> 32'])
    """
    losses, gains = [], []
    for key in sorted(old.keys() & new.keys()):
        was, now = dict(zip(FIGURES, old[key])), dict(zip(FIGURES, new[key]))
        changed = ", ".join(f"{name} {was[name]:g} -> {now[name]:g}" for name in FIGURES[:4] if was[name] != now[name])
        line = f"{' '.join(key)}: {changed}"
        more = admitted(key, now) - admitted(key, was)
        if more < 0 or now["spills"] > was["spills"]:
            losses.append(line)
        elif more > 0 or now["spills"] < was["spills"] or now["stack"] < was["stack"]:
            gains.append(line)
    return losses, gains


def summary(rows):
    """The worst scene of each kernel and target, as a table in Markdown."""
    targets = [target for target in TARGETS if any(key[0] == target for key in rows)]
    lines = ["| kernel | " + " | ".join(targets) + " |", "|---" * (len(targets) + 1) + "|"]
    for kernel in sorted({key[2] for key in rows}):
        cells = []
        for target in targets:
            of = [figures for key, figures in rows.items() if (key[0], key[2]) == (target, kernel)]
            worst = [pick(row[i] for row in of) for i, pick in enumerate((max, max, max, min))] if of else None
            cells.append("{:g} / {:g} / {:g} / {:g}".format(*worst) if worst else "")
        lines.append(f"| `{kernel}` | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sundog", nargs="?", default=os.path.join(ROOT, "build/release/sundog"))
    parser.add_argument("--scenes", help="names in scenes, such as spheres,gallery/studio (default: all of both folders that load)")
    parser.add_argument("--targets", default=",".join(TARGETS))
    parser.add_argument("--table", default=os.path.join(ROOT, "docs/measurements/gpu-compilers.csv"))
    parser.add_argument("--keep", action="store_true", help="write the table; rows that were not measured stay")
    parser.add_argument("--tools", default=os.path.join(ROOT, "build/gpu_tools"), help="where --fetch unpacks compilers")
    parser.add_argument("--fetch", action="store_true")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    args = parser.parse_args()
    targets = args.targets.split(",")
    if unknown := [target for target in targets if target not in TARGETS]:
        parser.error(f"--targets: {', '.join(unknown)}: wanted {', '.join(TARGETS)}")
    tools = Tools(args.tools)
    if args.fetch:
        tools.fetch({TARGETS[target][0] for target in targets})
    makers = sorted({TARGETS[target][0] for target in targets})
    for maker in makers:
        if missing := tools.missing(maker):
            print(f"gpu_compilers: {maker}: {mends(missing)}", file=sys.stderr)
    if any(map(tools.missing, makers)):
        return 77
    versions = {target: tools.version(TARGETS[target][0]) for target in targets}
    scenes = args.scenes.split(",") if args.scenes else sorted(
        os.path.relpath(file, os.path.join(ROOT, "scenes"))[:-5] for folder in ("scenes", "scenes/gallery")
        for file in glob.glob(os.path.join(ROOT, folder, "*.json")) if "schema" not in file)
    rows, failures = {}, []
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        jobs, uses = {}, []
        for scene in scenes:
            for maker in makers:
                try:
                    programs = list(written_programs(args.sundog, scene, maker, os.path.join(folder, maker, scene)))
                except subprocess.CalledProcessError:
                    if args.scenes:
                        raise
                    print(f"gpu_compilers: {scene} is left out", file=sys.stderr)  # sundog printed the reason
                    break
                for text, file, options in programs:
                    for target in targets:
                        if TARGETS[target][0] == maker:
                            if (text, target) not in jobs:
                                jobs[text, target] = pool.submit(compiled, tools, target, options, file)
                            uses.append((target, scene, file, jobs[text, target]))
        for number, (target, scene, file, job) in enumerate(uses, 1):
            if sys.stderr.isatty():
                print(f"\r{number} of {len(uses)}", end="", file=sys.stderr)
            result = job.result()
            if isinstance(result, CompilerError):
                failures.append(f"{target} {scene} {os.path.basename(file)}: {result}")
                continue
            rows.update({(target, scene, kernel): figures for kernel, figures in result})
    last_versions, last = read_table(args.table)
    others = sorted(target for target in targets if last_versions.get(target, versions[target]) != versions[target])
    if others:
        print(f"not compared, for the compilers are not those of the table: {', '.join(others)}")
    losses, gains = differences({key: row for key, row in last.items() if key[0] not in others}, rows)
    print(summary(rows))
    for title, lines in (("fewer waves or more spills:", losses), ("less than in the last table:", gains), ("failed:", failures)):
        if lines:
            print("\n" + title + "\n" + "\n".join(lines))
    if args.keep and not failures:
        kept = {key: row for key, row in last.items() if key not in rows and key[0] not in others}
        write_table(args.table, {**last_versions, **versions}, {**kept, **rows})
    return 1 if failures or (losses and not args.keep) else 0


if __name__ == "__main__":
    sys.exit(main())
