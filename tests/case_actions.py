"""Actions of cases.py in a case's folder that take more than one command."""
import base64
import math
import os
import re
import shutil
import signal
import socket
import struct
import subprocess
import time
from pathlib import Path

from case_tools import TREE, Result, Skip, different, mean, pixel, read_picture, share

SPHERES = TREE / "scenes/spheres.json"
GROWING = ("--size", "64x48", "--samples", "4096", "--adaptive", "0.0005", "-q", "-o", "a.png", "--resume", "c.ck")


def write_todays_format(forger):
    """Has the forger write the header that checkpoints have today; their arrays are the same."""
    text = forger.read_text()
    text = text.replace("SUNDOGP3", "SUNDOGF1").replace(
        "'<QiiiiIIIIIIII',key,w,h,4,4,1,1,0,0,0,0,1,1", "'<Qiiii10I',key,w,h,4,4,*struct.unpack('<I',b[32:36]),0,1,1,0,0,0,1,1,0")
    forger.write_text(text)


def forged_checkpoint(case, what):
    """The case's forger over a checkpoint of today; the render that takes it up."""
    if not (case.folder / "scenes").exists():
        (case.folder / "scenes").symlink_to(TREE / "scenes")
        (case.folder / "real.ck").unlink()
        write_todays_format(case.folder / "forge.py")
        case.run("python3", "forge.py", "0")
        if not (case.folder / "real.ck").exists():
            raise RuntimeError("no checkpoint was written")
    if what == "size":
        case.run("python3", "forge_size.py")
    else:
        case.run("python3", "forge.py", what)
    shutil.copy(case.folder / ("size.ck" if what == "size" else "forged.ck"), case.folder / "c.ck")
    return case.sundog("render", "scenes/spheres.json", *GROWING, "--time-limit", "3")


def huge_json(case):
    case.run("bash", "make.sh")
    return case.sundog("info", "arr8.json")


def same_files(case, a, b):
    return (case.folder / a).read_bytes() == (case.folder / b).read_bytes()


def left_over(case, *patterns):
    return sorted(path.name for pattern in patterns for path in case.folder.glob(pattern))


def talk(url, *texts):
    """Sends messages to the viewer as its page does; what it answers to the last within three seconds."""
    port, token = re.match(r"http://127\.0\.0\.1:(\d+)/#token=([0-9a-f]+)", url).groups()
    answer = b""
    with socket.create_connection(("127.0.0.1", int(port))) as link:
        key = base64.b64encode(os.urandom(16)).decode()
        link.sendall(f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: http://127.0.0.1:{port}\r\nUpgrade: websocket\r\n"
                     f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
        while b"\r\n\r\n" not in answer:
            answer += link.recv(4096)
        for text in (token, *texts):
            body, mask = text.encode(), os.urandom(4)
            link.sendall(bytes([0x81, 0x80 | len(body)]) if len(body) < 126 else struct.pack(">BBH", 0x81, 0xFE, len(body)))
            link.sendall(mask + bytes(b ^ mask[i % 4] for i, b in enumerate(body)))
        link.settimeout(1)
        end = time.monotonic() + 20
        while time.monotonic() < end and b"refused" not in answer:
            try:
                got = link.recv(65536)
            except TimeoutError:
                continue
            answer += got
            if not got:
                break
    return answer.decode(errors="replace")


def send_pick(case):
    server = subprocess.Popen([case.program, "serve", SPHERES], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        answer = talk(server.stdout.readline().strip(), (case.folder / "pick.txt").read_text())
        alive = server.poll() is None
    finally:
        server.send_signal(signal.SIGINT)
        server.wait(30)
    return Result(0 if alive else server.returncode, "".join(re.findall(r'\{"[^{}]*refused[^{}]*\}', answer)) or answer[:200], 0)


def cold_renders(case):
    """The picture's mean after each of three renders that a limit ends while kernels compile, with one checkpoint."""
    case.picture(SPHERES, "--size", "40x30", out="a.pfm")
    light = []
    for _ in range(3):
        done = case.sundog("render", SPHERES, "--size", "40x30", "--samples", "64", "-o", "a.pfm", "--time-limit", "1",
                           "--resume", "c.ck", env={"XDG_CACHE_HOME": f"{case.folder}/cold"})
        light.append(mean(read_picture(case.folder / "a.pfm")) if done.status == 0 else -1)
    return tuple(light)


def unlike(case, scene, setting, *options):
    """The share of pixels that a setting changes."""
    return different(case.picture(scene, *options), case.picture(scene, "--set", setting, *options))


def halves(case, scene):
    picture = case.picture(scene)
    return *pixel(picture, 0.4), *pixel(picture, 0.6)


def above_below(case, scene):
    picture = case.picture(scene)
    return pixel(picture, 0.1, 0.1)[0], pixel(picture, 0.1, 0.9)[0]


def model_colour(case, model):
    """A model's colour under lights of sundog's own, as a share of its red."""
    red, green, blue = pixel(case.picture(model, "--size", "33x25"))
    return (1, green / red, blue / red) if red > 0 else (0, green, blue)


def edge(case, scene):
    picture = case.picture(scene)
    return pixel(picture, 0.49)[0] / pixel(picture, 0.51)[0]


def balls(case, *places):
    """The red that the balls at these places of furnace.json return at their middles."""
    picture = case.picture("furnace.json")
    return tuple(mean(picture, u - 0.01, 0.45, u + 0.01, 0.55, channel=0) for u in places)


def caustic_sides(case, scene):
    """The caustic's light right of the middle over that left of it."""
    picture = case.picture(scene, "--size", "160x120")
    return mean(picture, 0.51, 0.45, 0.95, 0.95) / mean(picture, 0.05, 0.45, 0.49, 0.95)


def specks(case, scene):
    """How many pixels of the shadow are far above their neighbours, right of the middle over left of it."""
    picture = case.picture(scene)
    height, width = len(picture), len(picture[0])
    beside = ((-1, 0), (1, 0), (0, -1), (0, 1))
    bright = lambda x, y: picture[y][x][1] > 0.05 + 3 * max(picture[y + dy][x + dx][1] for dx, dy in beside)
    rows = range(int(0.65 * height), int(0.95 * height))
    count = lambda u0, u1: sum(bright(x, y) for y in rows for x in range(int(u0 * width), int(u1 * width)))
    return count(0.52, 0.7) / max(1, count(0.3, 0.48))


def links(case):
    (case.folder / "real").mkdir()
    (case.folder / "out.png").symlink_to("real/pic.png")
    case.render("s.json", "--size", "32x24", out="out.png")
    os.mkfifo(case.folder / "pipe.png")
    reader = subprocess.Popen(["head", "-c4", case.folder / "pipe.png"], stdout=subprocess.PIPE)
    case.render("s.json", "--size", "32x24", out="pipe.png", seconds=60)
    read_bytes = reader.communicate(timeout=5)[0] if (case.folder / "pipe.png").is_fifo() else reader.kill()
    return (case.folder / "out.png").is_symlink(), (case.folder / "real/pic.png").exists(), read_bytes == b"\x89PNG"


def strange_home(case):
    if os.geteuid() != 0:
        raise Skip("only root renders as another user")
    (case.folder / "home").mkdir(mode=0o700)
    (case.folder / "open").mkdir()
    (case.folder / "open").chmod(0o777)
    return case.render("s.json", "--size", "32x24", out="open/a.png", user=65534, group=65534, extra_groups=[],
                       env={"XDG_CACHE_HOME": None, "HOME": f"{case.folder}/home"})


def without_locks(case):
    case.run("cc", "-shared", "-fPIC", "nolock2.c", "-o", "nolock2.so", "-ldl")
    for name in ("nl1", "nltmp"):
        (case.folder / name).mkdir()
    return case.render("s.json", "--size", "32x24", env={
        "NOLOCK_UNDER": f"{case.folder}/nl", "XDG_CACHE_HOME": f"{case.folder}/nl1", "TMPDIR": f"{case.folder}/nltmp",
        "LD_PRELOAD": f"{case.folder}/nolock2.so"})


def cache_without_exec(case):
    (case.folder / "ne").mkdir()
    mount = "mount -t tmpfs -o noexec tmpfs ne"
    if case.run("unshare", "-m", "sh", "-c", mount).status != 0:
        raise Skip("nothing can be mounted here")
    return case.run("unshare", "-m", "sh", "-c", f"{mount} && exec \"$@\"", "sh", case.program, "render", "s.json",
                    "--size", "32x24", "-q", "-o", "a.png", env={"XDG_CACHE_HOME": f"{case.folder}/ne"})


def black_ground(case, scene):
    """The share of black pixels below the middle, before a white sky."""
    picture = case.picture(scene, "--set", "/image/background=[1,1,1]")
    return share(picture, lambda p: p[1] < 1e-4, 0.6)


def milk(case, limit):
    """Over what Chandrasekhar's H-function gives for light that falls straight on an endless depth: albedo H(1)^2 / 8."""
    albedo, count = 0.999, 200
    points = [(i + 0.5) / count for i in range(count)]
    h = [1.0] * count
    at = lambda mu: 1 / (math.sqrt(1 - albedo) + albedo / 2 * sum(m * v / (mu + m) for m, v in zip(points, h)) / count)
    for _ in range(60):
        h = [at(mu) for mu in points]
    scene = case.folder / "milk.json"
    scene.write_text(re.sub(r'"max_depth": *\d+', f'"max_depth": {limit}' if limit else '"caustics": false', scene.read_text()))
    return mean(case.picture("milk.json")) / (albedo * at(1.0) ** 2 / 8)


def bevel(case):
    assets = case.folder.parent.parent / "assets"
    if not assets.exists():
        raise Skip("no assets beside the cases")
    picture = case.picture("bevel.json", "--allow-outside-files")
    return sum(p == (0, 0, 0) for row in picture for p in row)


def photons_over_paths(case, scene, place, *options):
    """The light of a place with photons over that without."""
    lit = [mean(case.picture(scene, "--set", f"/render/caustics={how}", *options), *place) for how in ("true", "false")]
    return lit[0] / lit[1]


def longest_run(case, scene, *options):
    """The most neighbours of one value in a column of the picture's dark part."""
    picture = case.picture(scene, "--size", "96x720", *options, out="out.png")
    longest = 0
    for x in range(0, 96, 8):
        run = 0
        for above, below in zip(picture[360:], picture[361:]):
            run = run + 1 if above[x] == below[x] else 0
            longest = max(longest, run)
    return longest


def denoised(case, scene, samples):
    """The error of a denoised picture over that of the one with noise, against many samples; a pixel's counts to 0.1 at most."""
    small = ("--size", "160x120")
    if "libOpenImageDenoise" in case.render(scene, "--size", "8x6", "--denoise").text:
        raise Skip("no Open Image Denoise (SUNDOG_OIDN)")
    truth = case.picture(scene, *small, "--samples", samples)
    noisy, clean = case.picture(scene, *small), case.picture(scene, *small, "--denoise")
    error = lambda picture: sum(min(abs(p[1] - q[1]), 0.1) for row, other in zip(picture, truth) for p, q in zip(row, other))
    return error(clean) / error(noisy)


def dots(picture):
    """Pixels half as bright again as each of their neighbours."""
    around = [(dx, dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1) if dx or dy]
    return sum(picture[y][x][1] > 0.05 + 1.5 * max(picture[y + dy][x + dx][1] for dx, dy in around)
               for y in range(1, len(picture) - 1) for x in range(1, len(picture[0]) - 1))


# Programs over the library. All but PoCL's driver is hidden, as on a fresh system.
def with_pocl(case):
    vendors = case.folder / "vendors"
    if not vendors.exists() and Path("/etc/OpenCL/vendors/pocl.icd").exists():
        vendors.mkdir()
        shutil.copy("/etc/OpenCL/vendors/pocl.icd", vendors)
    return {"OCL_ICD_VENDORS": f"{vendors}/"} if vendors.exists() else {}


def prefix(case):
    """libsundog as it is installed; the files that name PREFIX and SUNDOG_ROOT are given the folders."""
    build, where = Path(case.program).resolve().parent, case.folder / "prefix"
    if not (build / "cmake_install.cmake").exists():
        raise Skip("the program is not in a build folder")
    if not where.exists():
        for component in ("library", "development"):
            case.run("cmake", "--install", build, "--component", component, "--prefix", where)
        # The cases were written when the library was of version 0.1.
        (where / "lib" / "libsundog.so.0.1").symlink_to("libsundog.so")
        for file in (path for pattern in ("c/*", "cpp/*", "iso/*") for path in case.folder.glob(pattern)):
            file.write_text(file.read_text().replace("PREFIX", str(where)).replace("SUNDOG_ROOT", str(TREE)))
    return where


def compiled(case, source, *arguments, times=1):
    """Runs a program that is compiled over the library; the first run that ends badly, or the last."""
    installed = prefix(case)
    compiler = ["c++", "-std=c++20"] if source.endswith(".cpp") else ["cc"]
    built = case.run(*compiler, "-O1", f"-I{installed}/include", source, "-o", "a.out", f"-L{installed}/lib", "-lsundog",
                     f"-Wl,-rpath,{installed}/lib", "-pthread", "-ldl")
    if built.status != 0:
        raise RuntimeError(built.text.strip()[:300])
    return repeated(case, times, case.folder / "a.out", *arguments)


def repeated(case, times, *command):
    for _ in range(times):
        result = case.run(*command, env=with_pocl(case), seconds=150)
        if result.status != 0:
            break
    return result


def two_libraries(case):
    library = prefix(case) / "lib/libsundog.so.0.1"
    copies = [case.folder / name for name in ("one.so", "two.so")]
    for copy in copies:
        shutil.copy(library, copy)
    return compiled(case, "iso/twolib.c", *copies, times=20)


def python(case, script, *arguments, times=1, needs=("sundog", "numpy")):
    for module in needs:
        if case.run(case.python, "-c", f"import {module}").status != 0:
            raise Skip(f"{case.python} has no {module}")
    return repeated(case, times, case.python, script, *arguments)


def package_config(case):
    return case.run("pkg-config", "--cflags", "sundog", env={"PKG_CONFIG_LIBDIR": f"{prefix(case)}/lib/pkgconfig"})


def fetched(case):
    """Configures a user's project that fetches a clone."""
    prefix(case)
    user = case.folder / "user"
    user.mkdir()
    text = (case.folder / "cpp/fetch_CMakeLists.txt").read_text()
    (user / "CMakeLists.txt").write_text(text.replace("sundog_shared", "sundog::sundog"))
    (user / "main.cpp").write_text("int main() {}\n")
    return case.run("cmake", "-S", user, "-B", user / "build", "-G", "Ninja", seconds=600)


def stopped_growth(case):
    """How many MB of addresses 1,500 stopped renders take."""
    sizes = [int(s) for s in re.findall(r"VmSize (\d+)", compiled(case, "iso/stopvm.cpp", "0").text)]
    return sizes[-1] - sizes[1]


def slowest_stop(case):
    done = python(case, "py/stop_in_compile.py", "dict")
    times = re.findall(r"([\d.]+) s after|took ([\d.]+)", done.text)
    return max(float(a or b) for a, b in times) if len(times) == 3 else done


def viewer(case, script, *arguments, seconds=600):
    """The output of a script that drives the viewer in a browser."""
    if not shutil.which("chromium") or not shutil.which("chromedriver"):
        raise Skip("no chromium and chromedriver")
    for module in ("selenium", "numpy", "PIL"):
        if case.run(case.python, "-c", f"import {module}").status != 0:
            raise Skip(f"{case.python} has no {module}")
    if not (case.folder / "run.sh").exists():
        (case.folder / "run.sh").write_text(f'#!/bin/sh\nexec {case.program} "$@"\n')
        (case.folder / "run.sh").chmod(0o755)
        shutil.copytree(TREE / "scenes", case.folder / "scenes")
        (case.folder / "shots").mkdir()
        for file in case.folder.glob("*.py"):
            text = file.read_text().replace("FRESH", str(case.folder)).replace("V_DIR", str(case.folder))
            text = text.replace("'1. Point'", "'2. Point'")  # its place after the first light is removed
            file.write_text(text.replace("ASSETS", str(case.folder.parent.parent / "assets")))
    return case.run(case.python, "-u", script, *arguments, seconds=seconds)


def lights_agree(case):
    """Whether page and server print the same lights after each edit."""
    pairs = re.findall(r"page (\[.*?\]|\d+) ?server (\[.*?\]|\d+)", viewer(case, "bug1_wrong_light.py").text)
    return len(pairs) >= 4 and all(a == b for a, b in pairs)


def undone(case):
    """The formulas in editor and server after each of two steps back."""
    return tuple(re.findall(r"editor '(.*?)' server (.*?) sent", viewer(case, "bug3_undo_editor.py").text)[:2])
