#!/usr/bin/env python3
"""Runs the cases of a folder beside the project (small inputs that sundog once got wrong) and prints a table.

    tests/cases.py SUNDOG [CASES] [--only TEXT]... [--python PYTHON]

CASES is by default the folder `cases` beside SUNDOG_ASSETS, or else ../shared/cases. Each case runs in a copy. The exit status
is 1 where one is wrong. PYTHON (default: this one) has the package sundog, numpy and cffi for library/py, and selenium, numpy
and pillow for viewer; rows that lack something are skipped. --only takes the rows whose name has the text.
"""
import argparse
import os
import shutil
import sys
import tempfile
from pathlib import Path

from case_actions import *
from case_tools import *

SMALL, FEW = ("--size", "32x24", "--samples", "1"), ("--size", "160x120", "--samples", "16")
RED, GREEN = (1, 0, 0), (0, 1, 0)
# The case, what is measured, how, and what is right.
ROWS = [
    ("half_filled_field", "warnings", lambda c: c.render("h_field.json"), quiet),
    ("hostile_4096_textures", "error", lambda c: (c.run("bash", "make.sh"), c.sundog("info", "t4098.json"))[1],
     says(r"more than 4096 images(?!.*inside each other)")),
    ("hostile_checkpoint_memory", "forged size", lambda c: forged_checkpoint(c, "size"),
     says("10000x9000 pixels in 80 bytes", mib=500)),
    ("hostile_checkpoint_oob", "pixel far outside", lambda c: forged_checkpoint(c, "0x7fff7fff"), says("damaged")),
    ("hostile_checkpoint_oob", "pixel just outside", lambda c: forged_checkpoint(c, "0x00500000"), says("damaged")),
    ("hostile_exr_2gib", "environment", lambda c: c.sundog("info", "scene.json"), says("2147483647 bytes", mib=300)),
    ("hostile_exr_2gib", "texture", lambda c: c.sundog("info", "scene2.json"), says("2147483647 bytes", mib=300)),
    ("hostile_json_memory", "24 MB of lists", huge_json, says("objects", mib=300)),
    ("hostile_output_over_texture", "refused", lambda c: c.render("scene.json", out="dial.png"), says("written over")),
    ("hostile_output_over_texture", "texture", lambda c: same_files(c, "dial.png", "orig.png"), is_(True)),
    ("hostile_part_memcpy_null", "merge", lambda c: c.sundog("merge", next(c.folder.glob("part*")), "-o", "x.png"),
     says("damaged|part")),
    ("hostile_pick_cast", "message to the viewer", send_pick, says("refused", 0)),
    ("hostile_sigxfsz", "render", lambda c: c.render(SPHERES, *SMALL, limits={"RLIMIT_FSIZE": 0}), says("limit")),
    ("hostile_sigxfsz", "files left", lambda c: left_over(c, "*.tmp"), is_([])),
    ("hostile_source_date_epoch", "refused", lambda c: c.render(SPHERES, *SMALL, "--metadata", out="x.png", env={
        "SOURCE_DATE_EPOCH": "9" * 20}), says("SOURCE_DATE_EPOCH", 2)),
    ("hostile_time_limit_cold", "light after each of three", cold_renders, at_least(0.05)),
    ("reports_01", "left, right", lambda c: halves(c, "scene.json"), near(*RED, *GREEN)),
    ("reports_02", "pixel", lambda c: pixel(c.picture("scene.json")), near(0.5, 0, 0)),
    ("reports_03", "COLOR_0's alpha blends", lambda c: pixel(c.picture("blend.json")), near(0.25, 0, 0)),
    ("reports_03", "and cuts", lambda c: pixel(c.picture("mask.json")), near(0, 0, 0)),
    ("reports_04", "white at a distance", lambda c: pixel(c.picture("w0.json", "--size", "8x6")), near(1, 1, 1)),
    ("reports_04", "as an OBJ", lambda c: pixel(c.picture("obj.json", "--size", "8x6")), at_least(0.7)),
    ("reports_04", "red and green", lambda c: pixel(c.picture("packed.json")), near(0.5, 0.5, 0, within=0.05)),
    *[("reports_05", f"strays of {name}", lambda c, n=name: strays(c.picture(f"{n}.json")), at_most(3))
      for name in ("power16", "julia_power16")],
    *[("reports_05", f"{name} unlike 16", lambda c, n=name: unlike(c, f"{n}.json", "/objects/0/bailout=16"), at_most(0.02))
      for name in ("bailout1000", "bailout1e9", "own_bailout1000")],
    *[("reports_06", name, lambda c, n=name: mean(c.picture(f"{n}.json"), 0.4, 0.4, 0.6, 0.6), near(wanted, within=0.05))
      for name, wanted in (("bump_0", 0.97), ("bump_180", 0), ("normal_0", 0.97), ("normal_180", 0))],
    ("reports_07", "above, below the horizon", lambda c: above_below(c, "scene.json"), near(1, 0)),
    *[("reports_08", name, lambda c, n=name: model_colour(c, n), near(1, 0, 0))
      for name in ("mtllib_first.obj", "mtl_has_it.obj")],
    *[("reports_08", name, lambda c, n=name: c.render(n, *SMALL), says("", 0)) for name in ("v_first.obj", "b.ply", "b.stl")],
    ("reports_09", "pixel", lambda c: pixel(c.picture("scene.json"))[0], near(0.2159)),
    *[("reports_10", name, lambda c, n=name: c.render(n, *SMALL), says("", 0))
      for name in ("vn.obj", "vn_ind.obj", "vt.obj", "n.ply")],
    ("reports_11", "pixel", lambda c: pixel(c.picture("scene.json")), near(*RED)),
    *[("reports_12", name, lambda c, n=name: c.render(f"{n}.obj", *SMALL), says(wanted, 0))
      for name, wanted in (("tga", ""), ("missing", "warning.*gone.png"), ("empty", ""))],
    *[("reports_12", name, lambda c, n=name: model_colour(c, f"{n}.obj"), near(1, 0, 0)) for name in ("case", "quoted")],
    ("reports_13", "furnace", lambda c: mean(c.picture("furnace.json"), 0.4, 0.4, 0.6, 0.6), at_most(1.01)),
    ("reports_13", "one lamp", lambda c: pixel(c.picture("light.json"))[0], at_most(1.01)),
    ("reports_14", "name of 300 characters", lambda c: c.render("s.json", *SMALL, out="y" * 300 + ".png"), says("too long")),
    ("reports_15", "link, its target, pipe", links, is_((True, True, True))),
    *[("reports_16", f"--device {n}", lambda c, n=n: c.render("s.json", *SMALL, "--device", n), says("P:D", 4)) for n in (0, 1)],
    ("reports_17", "left over right of the edge, off", lambda c: edge(c, "off.json"), near(0.7)),
    ("reports_17", "groups", lambda c: edge(c, "groups.json"), near(0.7)),
    ("reports_18", "a percent sign", lambda c: c.render("a.gltf", *SMALL), says("", 0)),
    *[("reports_19", f"ulimit -v {kib}", lambda c, k=kib: c.render("s.json", *SMALL, limits={"RLIMIT_AS": k * 1024}, seconds=120),
       says("^$|limit|ulimit|address space", (0, 1, 4, 5))) for kib in (1200000, 1400000, 1460000, 1500000, 1540000, 1580000)],
    ("reports_20", "STL in capitals", lambda c: c.render("up.stl", *SMALL), says("", 0)),
    ("reports_21", "coverage", lambda c: share(c.picture("s.json"), lambda p: p[0] > 0.5), near(0.276)),
    ("reports_22", "a home that may not be entered", strange_home, says("warning", 0)),
    ("reports_23", "without locks", without_locks, says("^$|lock", (0, 5))),
    ("reports_23", "left behind", lambda c: left_over(c, "nl1/sundog/pocl/*", "nltmp/*"), is_([])),
    ("reports_24", "a cache mounted noexec", cache_without_exec, says("", 0)),
    ("reports_24", "PATH without ld",
     lambda c: c.render("s.json", *SMALL, env={"PATH": "/nonexistent", "XDG_CACHE_HOME": f"{c.folder}/x"}),
     says("^$|ld", (0, 5))),
    ("reports_25", "unlike thickness 0.001", lambda c: unlike(c, "gyroid0.json", "/objects/0/parameters/thickness=0.001"),
     at_most(0.05)),
    ("reports_26", "through twelve holes", lambda c: tuple(pixel(c.picture(f"{n}.json"), 0.42)[0] for n in ("whitted", "path")),
     near(1, 1)),
    *[("truth_bigball", f"{name}, black", lambda c, n=name: black_ground(c, f"{n}.json"), at_most(0))
      for name in ("rtiow_ground", "big_box", "torus")],
    ("truth_whitted_metal", "furnace, four balls", lambda c: balls(c, 0.371, 0.457, 0.543, 0.629), at_most(1.02)),
    ("truth_whitted_coat", "on black", lambda c: mean(c.picture("furnace.json"), 0.45, 0.45, 0.55, 0.55),
     near(0.04, within=0.01)),
    ("truth_whitted_coat", "on white",
     lambda c: mean(c.picture("furnace.json", "--set", "/materials/m/base_color=[1,1,1]"), 0.4, 0.4, 0.6, 0.6),
     at_most(1.01)),
    ("truth_moving_caustic", "photons over paths", lambda c: photons_over_paths(c, "moving.json", (0, 0, 0.5, 0.5)),
     near(1, within=0.06)),
    ("truth_clearcoat", "none, half, full", lambda c: balls(c, 0.364, 0.5, 0.636), near(0.04, 0.058, 0.077, within=0.005)),
    ("truth_sheen_texture", "black, none", lambda c: balls(c, 0.376, 0.624), near(0.034, 0.034, within=0.006)),
    ("truth_bevel", "black pixels", bevel, at_most(0)),
    ("truth_depth", "depth of 1,024 over the truth", lambda c: milk(c, 1024), near(1, within=0.03)),
    ("truth_depth", "without a depth", lambda c: milk(c, None), near(1, within=0.03)),
    ("truth_field_overlap", "warnings", lambda c: c.render("two.json"), quiet),
    ("picture_faults", "01 light behind a plane", lambda c: mean(c.picture("01_photons_through_plane.json", *FEW)), at_most(0)),
    ("picture_faults", "02 sun hidden from the camera",
     lambda c: unlike(c, "02_invisible_sun.json", "/lights/0/visible=true", "--size", "60x60", "--samples", "8"),
     at_most(0)),
    ("picture_faults", "03 warnings", lambda c: c.render("03_stray_fractal_in_ice_in_liquid.json", "--samples", "4"), quiet),
    ("picture_faults", "04 error after / before denoising", lambda c: denoised(c, "04_denoise_lens.json", "512"), at_most(0.5)),
    ("picture_faults", "05 behind glass", lambda c: denoised(c, "05_denoise_behind_glass.json", "256"), at_most(0.8)),
    ("picture_faults", "05 white dots", lambda c: dots(c.picture("05_denoise_behind_glass.json", "--size", "160x120", "--samples",
                                                                 "256", "--set", "/render/max_component=4")), at_most(5)),
    ("picture_faults", "06 fog without light", lambda c: c.render("06_fog_no_sun.json", *FEW), says("warning: /world/fog", 0)),
    ("picture_faults", "07 openpbr over phong", lambda c: caustic_sides(c, "07_caustic_on_openpbr.json"), near(1, within=0.25)),
    ("picture_faults", "07b caustic on glTF", lambda c: mean(c.picture("07b_caustic_on_gltf.json", *FEW), 0.46, 0.54, 0.54, 0.62),
     at_least(0.5)),
    ("picture_faults", "07c photons over paths",
     lambda c: photons_over_paths(c, "07c_large_lamp.json", (0.51, 0.45, 0.65, 0.7), *FEW),
     near(1, within=0.1)),
    ("picture_faults", "08 openpbr over dielectric", lambda c: caustic_sides(c, "08_openpbr_glass.json"), near(1, within=0.1)),
    ("picture_faults", "09 specks, glossy over matte", lambda c: specks(c, "09_glossy_photons.json"), at_most(1.5)),
    ("picture_faults", "10 longest step over undithered",
     lambda c: longest_run(c, "10_banding.json") / longest_run(c, "10_banding.json", "--no-dither"),
     at_most(0.4)),
    ("library", "1 GIL, frames", lambda c: python(c, "py/repro_gil_loop.py", "61", "20"), says("all frames", 0)),
    *[("library", f"1 GIL, {how}", lambda c, h=how: python(c, "py/repro_gil_deadlock.py", h), says("came back", 0))
      for how in ("function", "reassign")],
    ("library", "2 first use by threads", lambda c: compiled(c, "iso/first2.cpp", "4", "0", "1", times=10), says("^done$", 0)),
    ("library", "2 in Python", lambda c: python(c, "py/first_threads.py", times=5), says("8 renders", 0)),
    ("library", "2 asyncio", lambda c: python(c, "py/first_async.py", times=5), says("4", 0)),
    ("library", "2 two copies, 20 times", two_libraries, says("both", 0)),
    ("library", "3 glass", lambda c: compiled(c, "cpp/glass_min.cpp"), says("^ok", 0)),
    ("library", "4 dlclose", lambda c: compiled(c, "c/dl.c", "render", "3"), says("end", 0)),
    ("library", "4 cffi", lambda c: (prefix(c), python(c, "c/user.py", needs=("cffi", "numpy")))[1], says("sphre", 0)),
    ("library", "5 fork in Python", lambda c: python(c, "py/mp.py", "fork", "devices"), says("spawn", 0)),
    ("library", "5 fork in C", lambda c: compiled(c, "iso/fork.c", "devices"), says("child: status [1-9].*spawn", 0)),
    ("library", "6 pkg-config", package_config, says("-I", 0)),
    ("library", "7 FetchContent", fetched, says("Generating done", 0)),
    ("library", "8 MB of addresses", stopped_growth, at_most(600)),
    ("library", "9 seconds to stop", slowest_stop, at_most(1)),
    ("viewer", "lights of page and server", lights_agree, is_(True)),
    ("viewer", "width of 65536", lambda c: viewer(c, "bug2_crash.py", "65536", "1"), says("^(?!.*SERVER ENDED)", 0)),
    ("viewer", "undo in the editor", undone, is_(tuple((f"z = z^{n} + c",) * 2 for n in (4, 3)))),
    ("viewer", "undo, completion", lambda c: viewer(c, "t11_undo2.py"), says(r"Undo -> z = z\^4 \+ c", 0)),
    ("viewer", "typing", lambda c: viewer(c, "t8_typing.py"), says("^(?![\\s\\S]*LOST)", 0)),
    ("viewer", "typing, slowed", lambda c: viewer(c, "t8b_typing.py", seconds=900), says("^(?![\\s\\S]*[1-4]/4 scrambled)", 0)),
    ("viewer", "another scene", lambda c: viewer(c, "t17.py", seconds=120), says(r"opened .*dialogs [1-9]", (0, 1))),
]


def shown(found):
    """A found value in a line of the table."""
    if isinstance(found, Result):
        return f"{found.status}, {found.mib} MiB: {' '.join(found.text.split())[:110]}"
    number = lambda v: f"{v:.4g}" if isinstance(v, float) else str(v)
    return ", ".join(map(number, found)) if isinstance(found, tuple) else number(found)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("sundog", type=Path)
    assets = os.environ.get("SUNDOG_ASSETS")
    beside = Path(assets).resolve().parent if assets else TREE.parent / "shared"
    arguments.add_argument("cases", type=Path, nargs="?", default=beside / "cases")
    arguments.add_argument("--only", action="append", default=[])
    arguments.add_argument("--python", default=sys.executable)
    given = arguments.parse_args()
    if not given.cases.is_dir():
        print(f"{given.cases} is not there: nothing is run")
        return 0
    wrong, copies = 0, {}
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        root.chmod(0o755)
        (root / "bin").mkdir()
        (root / "bin/sundog").symlink_to(given.sundog.resolve())
        if (given.cases.parent / "assets").exists():
            (root / "assets").symlink_to(given.cases.resolve().parent / "assets")
        print("| case | measured | found | right | |\n|---|---|---|---|---|")
        for name, measured, find, right in ROWS:
            if given.only and not any(text in f"{name} {measured}" for text in given.only):
                continue
            if name not in copies:
                copies[name] = Case(root / "cases" / name, given.sundog.resolve(), given.python)
                shutil.copytree(given.cases / name, copies[name].folder, copy_function=shutil.copyfile)
                for path in [copies[name].folder, *copies[name].folder.rglob("*")]:
                    path.chmod(0o755)
            try:
                found = find(copies[name])
                verdict = "right" if right.test(found) else "WRONG"
            except Skip as missing:
                found, verdict = str(missing), "skipped"
            except Exception as error:
                found, verdict = f"{type(error).__name__}: {error}", "WRONG"
            wrong += verdict == "WRONG"
            cells = [text.replace("|", "/").replace("\n", " ") for text in (name, measured, shown(found), right.text, verdict)]
            print("| " + " | ".join(cells) + " |", flush=True)
    print(f"{wrong} wrong")
    return 1 if wrong else 0


sys.exit(main())
