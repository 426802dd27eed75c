"""The programs of python/README.md run, and the package keeps its promises of size and speed."""

import re
import subprocess
import sys

import gelbench as gb
import pytest


def test_the_programs_of_the_readme_run(root):
    pytest.importorskip("matplotlib").use("Agg")
    pytest.importorskip("tqdm")
    text = (root / "python/README.md").read_text(encoding="utf-8")
    names = {}
    for program in re.findall(r"```python\n(.*?)```", text, re.DOTALL):
        exec(program, names)
    assert names["solution"].forces[2] == pytest.approx(12.8746, rel=1e-3)


def test_importing_brings_in_no_package_that_only_some_methods_need():
    program = "import sys, gelbench; print([name for name in %r if name in sys.modules])"
    others = ["matplotlib", "scipy", "pandas", "pyarrow", "pyvista", "meshio", "pint", "tempfile", "SALib", "distributed"]
    done = subprocess.run([sys.executable, "-c", program % others], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_every_public_name_is_explained():
    for name in gb.__all__:
        own = getattr(gb, name)
        assert name == "__version__" or own.__doc__, name
        for key, member in vars(own).items() if isinstance(own, type) else ():
            if not key.startswith("_") and (callable(member) or isinstance(member, property)):
                assert member.__doc__, f"{name}.{key}"
