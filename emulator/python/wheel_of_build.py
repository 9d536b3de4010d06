"""Makes a wheel of the package in a build folder, with the shared library in it (PEP 517, PEP 427).

The build folder is ../../build, or what the variable TRAX_BUILD names. The package finds the programs there."""

import base64
import hashlib
import os
import pathlib
import sysconfig
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
METADATA = """\
Metadata-Version: 2.1
Name: trax
Version: {version}
Summary: Cycle-level emulator of a mobile ray-tracing accelerator
Requires-Python: >=3.10
Requires-Dist: cffi
Requires-Dist: numpy
Provides-Extra: tables
Requires-Dist: pandas; extra == "tables"
"""
WHEEL = "Wheel-Version: 1.0\nGenerator: trax\nRoot-Is-Purelib: false\nTag: {tag}\n"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Writes the wheel into a folder and returns its name."""
    build = pathlib.Path(os.environ.get("TRAX_BUILD", HERE.parents[1] / "build")).resolve()
    library, package = build / "lib/trax/libtraxemu.so", build / "lib/trax/python/trax"
    if not library.exists() or not (package / "declarations.h").exists():
        raise SystemExit(f"{build} has no libtraxemu.so: run ./setup.sh first; TRAX_BUILD names another build folder")
    version = (HERE.parents[1] / "VERSION").read_text().split()[0]
    tag = "py3-none-" + sysconfig.get_platform().replace("-", "_").replace(".", "_")
    files = {f"trax/{path.name}": path.read_bytes() for path in sorted(package.iterdir()) if path.is_file()}
    files["trax/libtraxemu.so"] = library.read_bytes()
    files["trax/bin.txt"] = f"{build / 'bin'}\n".encode()
    info = f"trax-{version}.dist-info"
    files[f"{info}/METADATA"] = METADATA.format(version=version).encode()
    files[f"{info}/WHEEL"] = WHEEL.format(tag=tag).encode()
    record = f"{info}/RECORD"
    name = f"trax-{version}-{tag}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory, name), "w", zipfile.ZIP_DEFLATED) as wheel:
        rows = []
        for path, data in files.items():
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            rows.append(f"{path},sha256={digest},{len(data)}\n")
            wheel.writestr(path, data)
        wheel.writestr(record, "".join(rows) + f"{record},,\n")
    return name
