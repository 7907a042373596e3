"""What all tests share."""

import os

import numpy as np
import pytest
from hypothesis import Phase, settings

import freepath as fp

# The same examples in every run, without a limit of time: a test that depends on the machine's speed
# says nothing. FREEPATH_EXAMPLES=1000 tries more of them.
settings.register_profile(
    "tests",
    derandomize=True,
    deadline=None,
    database=None,
    phases=[Phase.explicit, Phase.generate],  # to shrink examples of statistics leads nowhere
    max_examples=int(os.environ.get("FREEPATH_EXAMPLES", "10")),
)
settings.load_profile("tests")


@pytest.fixture
def cloud():
    """Voxels that differ along every axis, in a box of 4 x 5 x 6."""
    values = np.random.default_rng(7).random((4, 5, 6)).astype(np.float32)
    return fp.Field.from_array(values)


@pytest.fixture
def program():
    """The command line's program, if there is one."""
    path = os.environ.get("FREEPATH_PROGRAM", "")
    if not os.access(path, os.X_OK):
        pytest.skip("FREEPATH_PROGRAM names no program to compare with")
    return path
