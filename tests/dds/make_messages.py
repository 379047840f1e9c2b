# SPDX-License-Identifier: Apache-2.0
"""Makes the messages of ROS 2 that have no wheel, in an environment that has rclpy.

    VENV/bin/python make_messages.py FOLDER

FOLDER then holds the packages `tf2_msgs` and `map_msgs` for PYTHONPATH and their libraries for LD_LIBRARY_PATH. ROS's
own generators write the sources; g++ and Python's headers compile them.
"""

from __future__ import annotations

import importlib.metadata
import os
import shutil
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

import numpy

MESSAGES = {
    "tf2_msgs": (
        "TFMessage",
        '#include "geometry_msgs/msg/TransformStamped.idl"\n'
        "module tf2_msgs { module msg { struct TFMessage {\n"
        "  sequence<geometry_msgs::msg::TransformStamped> transforms;\n"
        "}; }; };\n",
    ),
    "map_msgs": (
        "OccupancyGridUpdate",
        '#include "std_msgs/msg/Header.idl"\n'
        "module map_msgs { module msg { struct OccupancyGridUpdate {\n"
        "  std_msgs::msg::Header header;\n"
        "  int32 x;\n  int32 y;\n  uint32 width;\n  uint32 height;\n"
        "  sequence<int8> data;\n"
        "}; }; };\n",
    ),
}
USED_PACKAGES = ("geometry_msgs", "std_msgs", "builtin_interfaces")
USED_KINDS = (
    "generator_c",
    "generator_py",
    "typesupport_c",
    "typesupport_fastrtps_c",
    "typesupport_fastrtps_cpp",
    "typesupport_introspection_c",
)
USED_LIBRARIES = (
    "rosidl_runtime_c",
    "rosidl_typesupport_c",
    "rosidl_typesupport_fastrtps_c",
    "rosidl_typesupport_fastrtps_cpp",
    "rosidl_typesupport_introspection_c",
    "fastcdr",
    "rcutils",
    "rmw",
)


def generate(package: str, interface: str, output: Path) -> None:
    """Writes the sources of a message."""
    # The wheels name each generator twice, which ROS's tool refuses.
    found = [point for one in importlib.metadata.distributions() for point in one.entry_points]
    unique = importlib.metadata.EntryPoints({(point.group, point.name): point for point in found}.values())
    importlib.metadata.entry_points = lambda **_: unique  # type: ignore[assignment]
    from rosidl_cli.cli import main

    sys.argv = ["rosidl", "generate", "-o", str(output), "-t", "c", "-t", "py"]
    sys.argv += [
        "-ts",
        "fastrtps_c",
        "-ts",
        "introspection_c",
        "-ts",
        "c",
        "-I",
        f"{sys.prefix}/share",
        package,
        interface,
    ]
    code = main()
    if code:
        raise SystemExit(code)


def run(*command: object) -> None:
    subprocess.run([str(part) for part in command], check=True)


def compile_sources(sources: Iterable[Path], output: Path, flags: list[str]) -> list[Path]:
    objects = []
    for source in sources:
        objects.append(output / f"{source.name}.o")
        standard = "-std=c++17" if source.suffix == ".cpp" else "-std=gnu11"
        run("g++" if source.suffix == ".cpp" else "gcc", standard, *flags, "-c", source, "-o", objects[-1])
    return objects


def build(package: str, generated: Path, folder: Path) -> None:
    """Makes a Python package, and the library that it loads, of the sources."""
    headers = generated / "include" / package / "msg"
    for kind in ("c", "fastrtps_c", "introspection_c"):
        shutil.copytree(generated / kind / "msg", headers, dirs_exist_ok=True)
    python = folder / package
    shutil.copytree(generated / "py" / "msg", python / "msg", dirs_exist_ok=True)
    (python / "__init__.py").touch()

    version = f"python{sys.version_info.major}.{sys.version_info.minor}"
    include = [generated / "include", Path(sys.prefix, "include"), *Path(sys.prefix, "include").iterdir()]
    include += [Path("/usr/include", version), Path(numpy.get_include())]
    flags = ["-O0", "-fPIC", "-w", *(f"-I{folder}" for folder in include)]
    libraries = [f"-L{sys.prefix}/lib", f"-Wl,-rpath,{sys.prefix}/lib", "-Wl,--no-as-needed"]
    libraries += [f"-l{used}__rosidl_{kind}" for used in USED_PACKAGES for kind in USED_KINDS]
    libraries += [f"-l{library}" for library in USED_LIBRARIES]

    sources = [*headers.glob("detail/*.c"), *headers.glob("detail/*.cpp"), *headers.glob("*.cpp")]
    sources += (generated / "py" / "msg").glob("*_s.c")
    objects = compile_sources(sources, generated, flags)
    support = f"{package}__rosidl_typesupport_fastrtps_c"
    run("g++", "-shared", "-o", folder / f"lib{support}.so", *objects, *libraries)
    # All are in one library, which ROS looks for by either name.
    (folder / f"lib{package}__rosidl_typesupport_introspection_c.so").symlink_to(f"lib{support}.so")
    module = compile_sources([generated / "py" / f"_{package}_s.ep.rosidl_typesupport_c.c"], generated, flags)
    extension = python / f"{package}_s__rosidl_typesupport_c.so"
    run(
        "g++",
        "-shared",
        "-o",
        extension,
        *module,
        f"-L{folder}",
        f"-Wl,-rpath,{folder}",
        f"-l{support}",
        *libraries,
    )


def main() -> None:
    folder = Path(sys.argv[1]).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    os.environ["AMENT_PREFIX_PATH"] = sys.prefix
    for package, (name, definition) in MESSAGES.items():
        sources = folder / "sources" / package
        idl = sources / "idl" / "msg" / f"{name}.idl"
        idl.parent.mkdir(parents=True)
        idl.write_text(definition, encoding="utf-8")
        generate(package, f"{sources / 'idl'}:msg/{name}.idl", sources / "generated")
        build(package, sources / "generated", folder)
    shutil.rmtree(folder / "sources")


if __name__ == "__main__":
    main()
