import subprocess
import sys

PROBE = """
import sys
import slamgym, slamgym.cli, slamgym.env, slamgym.wrappers, slamgym.slam.worker
bare = {name for name in sys.modules if name.split('.')[0] in {'scenes', 'agents', 'eval'}}
heavy = {'pyorbslam3', 'pyrender', 'OpenGL', 'pybullet', 'evo'} & set(sys.modules)
print(sorted(bare), sorted(heavy))
"""


def test_importing_does_nothing_and_takes_no_bare_names():
    result = subprocess.run([sys.executable, "-c", PROBE], capture_output=True, text=True, check=True, timeout=60)
    assert result.stdout.strip() == "[] []"
    assert result.stderr == ""
