"""What setup.py refuses."""
import os
import subprocess
import sys
from pathlib import Path

CHECKOUT = Path(__file__).resolve().parents[2]


def test_an_editable_install_says_what_to_type_instead():
    environment = {name: value for name, value in os.environ.items() if not name.startswith('CATKIN')}
    done = subprocess.run([sys.executable, 'setup.py', 'build_ext', '--inplace'], cwd=CHECKOUT, env=environment,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert done.returncode != 0
    assert 'pip install -e . would put the compiled parts into the checkout' in done.stdout and 'allowed: pip install .' in done.stdout
    assert not list((CHECKOUT / 'src/python/verlet_cable').glob('_simulation*.so'))
