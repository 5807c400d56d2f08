"""A thousand wrong calls end with an exception: see wrong_calls.py."""

import pathlib
import subprocess
import sys


def test_wrong_calls_raise_exceptions(tmp_path):
    script = pathlib.Path(__file__).with_name("wrong_calls.py")
    ended = subprocess.run([sys.executable, str(script), "2500", "3"], cwd=tmp_path, capture_output=True, text=True,
                           errors="replace", timeout=1500)
    assert ended.returncode == 0, ended.stdout + ended.stderr + (tmp_path / "last_call").read_text()
    number = int(ended.stdout.split()[0])
    print(ended.stdout)
    assert number >= 2500
    assert "0 wrong" in ended.stdout
