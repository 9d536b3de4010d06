"""Machines: the figures are those of trax-sim, memory is shared, errors are exceptions with the place."""

import gc
import json
import os
import pathlib
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy
import pytest

import trax

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from report.explore_page import unpack  # noqa: E402

VALUES = numpy.arange(1000, dtype=numpy.uint32)
HOST = ("host_seconds", "instructions_per_host_second", "program")


def sim(*words):
    """Statistics of trax-sim, without what is the host's."""
    command = [trax.tool("trax-sim"), "--quiet", "--stats", "-", *words]
    done = subprocess.run(command, stdout=subprocess.PIPE, check=True)
    return without_host(json.loads(done.stdout[done.stdout.index(b"{"):]))


def without_host(statistics):
    return {name: value for name, value in statistics.items() if name not in HOST}


def triple(programs, *machine, **run):
    made = trax.Machine(programs["triple"], *machine)
    made.bind("data", VALUES)
    return made, made.run(**run)


@pytest.mark.parametrize("engine", [None, "reference", "functional"])
def test_figures_are_those_of_trax_sim(programs, tmp_path, engine):
    (tmp_path / "data").write_bytes(VALUES.tobytes())
    _, run = triple(programs, "2x32", {"memory.bandwidth_gbps": 16}, engine=engine)
    expected = sim("--config", "2x32", "--set", "memory.bandwidth_gbps=16", "--bind", f"data={tmp_path}/data",
                   *(["--engine", engine] if engine else []), programs["triple"])
    assert without_host(run.statistics) == expected
    assert run.output == "1 \n" and run.exit_status == 0
    assert run["dcache.hits"] == expected["dcache"]["hits"] == run.figures()["dcache.hits"]
    assert "tms" in run.statistics and "tms" not in run.figures()


def test_page_has_the_differences_to_another_run(programs, tmp_path):
    pages = [tmp_path / name for name in ("one.html", "other.html")]
    triple(programs, "1x32", explore=pages[0])
    triple(programs, "2x32", explore=pages[1], against=pages[0])
    assert [page.read_text().count('id="against"') for page in pages] == [0, 1]
    with pytest.raises(trax.TraxError, match="none.json: No such file"):
        triple(programs, explore=pages[1], against=tmp_path / "none.json")
    with pytest.raises(trax.TraxError, match="needs --explore"):
        triple(programs, against=pages[0])


def test_page_has_the_sources_of_the_installation(manifest, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # sources below the current folder are taken anyway
    trax.Machine(manifest, "1x32").run(explore=tmp_path / "python.html")
    subprocess.run([trax.tool("trax-sim"), "--quiet", "--config", "1x32", "--explore", tmp_path / "sim.html", manifest],
                   check=True)
    mine, other = (unpack(tmp_path / name)[0]["sources"] for name in ("python.html", "sim.html"))
    assert mine == other and any(name.endswith("/traverse.h") for name in mine)


def test_page_has_the_sources_of_given_folders(tmp_path, monkeypatch):
    for folder in ("source", "program"):
        (tmp_path / folder).mkdir()
    (tmp_path / "source/one.c").write_text("int main(void) { return 0; }\n")
    program, page = trax.compile(tmp_path / "source/one.c", output=tmp_path / "program/one.elf"), tmp_path / "one.html"
    monkeypatch.chdir(tmp_path / "program")
    for folders, names in (([], []), ([tmp_path / "source"], ["one.c"])):
        trax.Machine(program).run(explore=page, source_folders=folders)
        assert [name for name in map(os.path.basename, unpack(page)[0]["sources"]) if name == "one.c"] == names


def test_picture_is_that_of_trax_render(manifest, tmp_path):
    assert trax.Machine(manifest).config["chip.tms"] == trax.Config("4x32")["chip.tms"]  # the manifest's
    run = trax.Machine(manifest, "1x32").run()
    assert run.picture.size == (48, 27) and run["rays"] > 48 * 27
    subprocess.run([trax.tool("trax-sim"), "--quiet", "--config", "1x32", "--dump", f"image={tmp_path}/image",
                    manifest], check=True)
    assert run.picture.pixels.tobytes() == (tmp_path / "image").read_bytes()
    run.picture.save(tmp_path / "picture.png")
    # A reader of other hands: the product's.
    trax_compare = subprocess.run([trax.tool("trax-compare"), tmp_path / "picture.png", tmp_path / "picture.png"],
                                  capture_output=True, text=True, check=False)
    assert trax_compare.returncode == 0, trax_compare.stderr


def test_picture_of_floats(manifest, tmp_path):
    """Linear floats have three channels; their square roots are the bytes of the program's own picture."""
    floats = trax.Machine(trax.prepare("generate:forest", folder=tmp_path / "run", size=(48, 27), options=("--float", ))
                          ).run().picture
    assert floats.pixels.shape == (27, 48, 3) and floats.pixels.dtype == numpy.float32 and floats.size == (48, 27)
    colours = trax.Machine(manifest).run().picture.pixels[:, :, :3]
    assert numpy.array_equal(numpy.floor(255 * numpy.sqrt(floats.pixels.clip(0, 1)) + 0.5), colours)


def test_buffers_are_the_memory_of_the_machine(programs):
    machine = trax.Machine(programs["triple"])
    machine.bind("data", VALUES)
    before = machine.buffer("data", numpy.uint32)
    assert (before == VALUES).all()
    machine.run()
    after = machine.buffer("data", numpy.uint32)
    assert (after == 3 * VALUES).all() and numpy.shares_memory(before, after)
    assert machine.symbol("counter")[0] == len(VALUES) + 1
    del machine
    gc.collect()
    assert (after == 3 * VALUES).all()  # the array keeps the machine
    with pytest.raises(ValueError):
        after[0] = 1


def test_zeros_and_arguments(programs):
    machine = trax.Machine(programs["triple"], arguments=["word"])
    machine.bind("data", 64)
    assert machine.run().output == "2 word\n"
    assert not machine.buffer("data").any() and len(machine.buffer("data")) == 64


def test_input(programs, tmp_path):
    (tmp_path / "text").write_text("HAL\n")
    with open(tmp_path / "text", "rb") as file:
        run = trax.Machine(programs["echo"]).run(input=file)
    assert run.output == "IBM\v" and run.exit_status == 3


def test_errors_have_places(programs, manifest):
    with pytest.raises(trax.TraxError, match="no-such.elf"):
        trax.Machine("no-such.elf")
    with pytest.raises(trax.TraxError, match="memory.latency"):
        trax.Config("4x32", {"memory.latency": 3})
    assert trax.Config("4x32", {"fpu.compare_units": numpy.bool_(True)})["fpu.compare_units"] is True
    with pytest.raises(trax.TraxError, match="chip.tms"):
        trax.Machine(programs["triple"], "4x32", {"chip.tms": 0})
    machine = trax.Machine(programs["triple"])
    with pytest.raises(trax.TraxError, match="nothing"):
        machine.bind("nothing", b"1234")
    with pytest.raises(trax.TraxError, match="-1"):
        machine.bind("data", -1)
    for name, value in (("explode", "x.html"), ("source_folder_count", 20), ("part_count", 1), ("story_places", None),
                        ("note", "x")):
        with pytest.raises(trax.TraxError, match="no option"):
            machine.run(explore="page.html", **{name: value})
    with pytest.raises(trax.TraxError, match="'no-folder' is no folder"):
        machine.run(explore="x.html", source_folders=["no-folder"])
    with pytest.raises(trax.TraxError, match="zero byte"):
        trax.Machine(f"{programs['triple']}\0x")
    with pytest.raises(trax.TraxError, match="engine"):
        trax.Machine(programs["triple"]).run(engine="steam")
    with pytest.raises(trax.TraxError, match="undeclared"):
        source = os.path.join(os.path.dirname(manifest), "wrong.c")
        with open(source, "w", encoding="utf-8") as file:
            file.write("int main(void) { return x; }")
        trax.compile(source, output=source + ".elf")
    for name in ("no-such.ply", os.fsdecode(b"no-such.ply\xff")):
        with pytest.raises(trax.TraxError, match="no-such.ply"):
            trax.prepare(name, folder="nowhere")
    with pytest.raises(trax.TraxError, match="--paths"):
        trax.prepare("no-such.ply", folder="nowhere", options=("--paths", "many"))


def test_no_output_is_an_input(programs, manifest, tmp_path):
    """Files that a machine was made of stay, by whichever name an explanation would be written."""
    other = tmp_path / "other.elf"
    other.symlink_to(programs["triple"])
    chip = tmp_path / "chip.cfg"
    chip.write_text("chip: { tms = 1; };\n")
    for program, path in ((programs["triple"], programs["triple"]), (programs["triple"], other),
                          (programs["triple"], chip), (manifest, manifest),
                          (manifest, os.path.join(os.path.dirname(manifest), "program.elf"))):
        with open(path, "rb") as file:
            before = file.read()
        with pytest.raises(trax.TraxError, match="is an input"):
            trax.Machine(program, str(chip)).run(explore=path)
        with open(path, "rb") as file:
            assert file.read() == before
    twice = str(tmp_path / "x.html")
    with pytest.raises(trax.TraxError, match="twice"):
        trax.Machine(programs["triple"]).run(explore=twice, profile=twice)
    with pytest.raises(trax.TraxError, match="is an input"):
        trax.Machine(programs["triple"]).run(explore=twice, against=twice)
    assert sorted(os.listdir(tmp_path)) == ["chip.cfg", "other.elf"]


def test_a_picture_is_whole_or_the_earlier_one(tmp_path):
    place = tmp_path / "picture.png"
    place.write_bytes(b"earlier")
    with pytest.raises(ValueError):
        trax.Picture(numpy.zeros((2, 3, 1), numpy.uint8)).save(place)
    assert place.read_bytes() == b"earlier" and os.listdir(tmp_path) == ["picture.png"]
    link = tmp_path / "link.png"
    link.symlink_to(place)
    picture = trax.Picture(numpy.zeros((2, 3, 4), numpy.uint8))
    picture.save(link)
    picture.save("/dev/null")
    assert link.is_symlink() and place.read_bytes() == picture.png()


def test_linear_pixels_become_bytes_by_the_srgb_curve():
    """By hand: 255 times the curve, rounded; below 0.0031308 it is a line."""
    pixels = numpy.array([[[0.5, 0.2, 0.001, 1], [2, -1, numpy.nan, 0]]], numpy.float32)
    assert trax.Picture(pixels).bytes().tolist() == [[[188, 124, 3], [255, 0, 0]]]


def test_a_machine_runs_once(programs, tmp_path):
    machine, _ = triple(programs)
    with pytest.raises(trax.TraxError, match="once"):
        machine.run(profile=tmp_path / "profile")
    assert not (tmp_path / "profile").exists()


def test_fault_and_limit_have_figures(programs):
    with pytest.raises(trax.Fault) as fault:
        trax.Machine(programs["fault"]).run()
    assert "0x70000000" in fault.value.report and fault.value.run["fault.address"] == "0x70000000"
    with pytest.raises(trax.Stuck) as stuck:
        trax.Machine(programs["loop"]).run(max_cycles=1000)
    assert stuck.value.run.cycles == 1000 and not isinstance(stuck.value, trax.Interrupted)


def test_explanations(programs, tmp_path):
    triple(programs, "1x32", profile=tmp_path / "profile.txt", series=tmp_path / "series.csv", series_interval=100)
    assert "main" in (tmp_path / "profile.txt").read_text()
    assert (tmp_path / "series.csv").read_text().count("\n") > 10


def test_progress_and_its_exceptions(programs):
    seen = []

    def look(cycle, instructions, items):
        seen.append((cycle, instructions, items))
        if len(seen) == 2:
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        trax.Machine(programs["loop"]).run(progress=look)
    assert len(seen) >= 2 and seen[1][0] > seen[0][0] and seen[1][2] == 0


def test_interrupt_from_another_thread(programs):
    machine = trax.Machine(programs["loop"])
    timer = threading.Timer(0.3, machine.interrupt)
    timer.start()
    with pytest.raises(trax.Interrupted) as interrupted:
        machine.run()
    assert interrupted.value.run.cycles > 0


@pytest.mark.parametrize("text", ["trax.Machine(path).run()", "trax.sweep(path, ['1x32', '2x32', '4x32'], jobs=2)"])
def test_control_c(programs, text):
    script = textwrap.dedent(f"""\
        import pandas, sys, trax  # a signal that comes while the first is being imported is lost
        path = sys.argv[1]
        print("begun", flush=True)
        {text}
        """)
    with subprocess.Popen([sys.executable, "-c", script, programs["loop"]], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True,
                          preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)) as process:
        process.stdout.readline()  # a job in the background of a shell would ignore the signal
        time.sleep(0.5)
        begin = time.monotonic()
        process.send_signal(signal.SIGINT)
        try:
            _, errors = process.communicate(timeout=60)
        finally:
            process.kill()
    assert "KeyboardInterrupt" in errors and process.returncode in (-signal.SIGINT, 130)
    assert time.monotonic() - begin < 30
