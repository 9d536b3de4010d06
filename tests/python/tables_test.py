"""Configurations, sweeps and tables."""

import json
import os
import pathlib
import subprocess
import sys
import threading
import time
import weakref

import numpy
import pytest

import trax

VALUES = numpy.arange(200, dtype=numpy.uint32)


def test_import_is_silent():
    """Whatever the version of cffi: newer ones warn of #pragma."""
    declarations = pathlib.Path(trax.__file__).with_name("declarations.h").read_text()
    assert "#" not in declarations
    subprocess.run([sys.executable, "-W", "error", "-c", "import trax"], check=True)


def test_configuration():
    config = trax.Config("4x32", {"memory.bandwidth_gbps": 16.5, "dcache.replacement": "lru"})
    assert config["chip.tms"] == 4 and config["memory.bandwidth_gbps"] == 16.5 and config["dcache.replacement"] == "lru"
    assert config.changes() == {
        "chip.tms": 4, "chip.tps_per_tm": 32, "memory.bandwidth_gbps": 16.5, "dcache.replacement": "lru"}
    other = config.copy()
    other["fpu.compare_units"] = True
    assert other["fpu.compare_units"] is True and config["fpu.compare_units"] is False
    assert len(config) == len(list(config)) > 60 and "simt.width" in config
    described = trax.describe_keys()
    assert all(key in described for key in config)


def test_configuration_is_a_file_of_trax_sim(tmp_path):
    config = trax.Config("2x48", {"memory.latency_cycles": 7})
    (tmp_path / "chip.cfg").write_text(config.text())
    assert dict(trax.Config(tmp_path / "chip.cfg")) == dict(config)
    assert trax.presets()[0] == "1x32" and "8x64" in trax.presets()


def test_sweep(programs):
    table = trax.sweep(programs["triple"], ["1x32", "2x32"], {"memory.latency_cycles": [50, 100]}, jobs=2,
                       setup=lambda machine: machine.bind("data", VALUES))
    assert list(table.columns[:2]) == ["chip", "memory.latency_cycles"]
    assert list(table["chip"]) == ["1x32", "1x32", "2x32", "2x32"]
    assert list(table["memory.latency_cycles"]) == [50, 100, 50, 100]
    for row in range(4):
        machine = trax.Machine(programs["triple"], table["chip"][row],
                               {"memory.latency_cycles": int(table["memory.latency_cycles"][row])})
        machine.bind("data", VALUES)
        assert machine.run().cycles == table["cycles"][row]


def test_sweep_keeps_no_machine(programs):
    """A machine's memory is free when its run has ended: a sweep has as many as jobs."""
    made, alive = [], []

    def setup(machine):
        alive.append(sum(one() is not None for one in made))
        made.append(weakref.ref(machine))
        machine.bind("data", VALUES)

    trax.sweep(programs["triple"], settings={"memory.latency_cycles": [50, 60, 70, 80]}, jobs=1, setup=setup)
    assert alive == [0, 0, 0, 0]


@pytest.mark.parametrize("chips, settings", [("4x32", {}), (trax.Config(), {}), ((None, ), {"memory.bytes": 100})])
def test_sweep_of_one_value(programs, chips, settings):
    """A word would be a list of letters."""
    with pytest.raises(trax.TraxError, match="expected a list of values"):
        trax.sweep(programs["triple"], chips, settings)


def test_sweep_ends_a_machine_that_was_being_made(programs, monkeypatch):
    """It is made while another one fails, and would run on."""
    begun, failed, ends = threading.Event(), threading.Event(), []

    class Slow(trax.Machine):
        def __init__(self, program, chip, settings):
            super().__init__(program, chip, settings)
            if chip == "2x32":
                begun.set()
                failed.wait()
                time.sleep(0.5)  # the sweep learns of the failure

        def run(self, **options):
            try:
                return super().run(**options)
            except trax.TraxError as error:
                ends.append(type(error))
                raise

    def setup(machine):
        if machine.config["chip.tms"] == 1:
            begun.wait()
            failed.set()
            raise ValueError

    monkeypatch.setattr(sys.modules["trax.sweep"], "Machine", Slow)
    with pytest.raises(ValueError):
        trax.sweep(programs["loop"], ["1x32", "2x32"], jobs=2, setup=setup, max_cycles=1_000_000)
    assert ends == [trax.Interrupted]


def test_tables_of_a_run(programs):
    machine = trax.Machine(programs["triple"], "2x32")
    machine.bind("data", VALUES)
    run = machine.run()
    assert len(run.tms()) == 2 and len(run.tps()) == 64
    causes = run.tps().filter(like="causes.")
    assert causes.to_numpy().sum() == run.cycles * 64 == run["identity.thread_cycles"]
    assert run.tms()["dcache.hits"].sum() == run["dcache.hits"] > 0
    table = trax.table([run], [{"name": "first"}])
    assert list(table.columns[:1]) == ["name"] and table["cycles"][0] == run.cycles


def test_results_of_an_evaluation(tmp_path):
    sweep = {"name": "x", "scenes": [{"name": "f", "meshes": ["generate:forest"], "view": "forest"}],
             "programs": "ours", "chips": ["1x32", "2x32"], "size": "8x4"}
    (tmp_path / "x.json").write_text(json.dumps(sweep))
    subprocess.run([sys.executable, trax.tool("trax-eval"), "x.json", ".", "-q", "-o", "out"], cwd=tmp_path, check=True)
    table = trax.results(tmp_path / "out/results.json")
    assert list(table["config"]) == ["1x32", "2x32"] and set(table["status"]) == {"done"}
    assert (table["width"] == 8).all() and table["cycles"][0] > table["cycles"][1] > 0


def test_results_of_something_else(tmp_path):
    for name, content in (("none.json", None), ("bytes.json", b"\xff\xfe"), ("list.json", b"[1]"),
                          ("empty.json", b"{}"), ("runs.json", b'{"runs": [3]}')):
        if content is not None:
            (tmp_path / name).write_bytes(content)
        with pytest.raises(trax.TraxError, match=name):
            trax.results(tmp_path / name)


def test_wheel(tmp_path):
    """pip's package of the tree is whole: the library is in it, and the programs are found."""
    source = pathlib.Path(__file__).parents[2] / "emulator/python"
    done = subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index", "--target",
                           tmp_path / "site", source], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "TRAX_BIN")}
    code = "import trax; print(trax.__file__); print(trax.tool('trax-sim')); print(trax.Config('4x32')['chip.tms'])"
    lines = subprocess.run([sys.executable, "-c", code], env=environment | {"PYTHONPATH": str(tmp_path / "site")},
                           capture_output=True, text=True, check=True).stdout.split("\n")
    assert lines[0].startswith(str(tmp_path)) and lines[2] == "4"
    assert lines[1] == str(pathlib.Path(os.environ["TRAX_BUILD"]).resolve() / "bin/trax-sim")
