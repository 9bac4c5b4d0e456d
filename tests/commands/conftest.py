"""What these tests ask of a run is not how its figures look."""

import pytest


@pytest.fixture(autouse=True)
def _no_pictures(no_pictures: None) -> None:
    """Of an analysis in the test's own process."""
