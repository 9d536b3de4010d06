"""The faults of a source."""


class Failed(Exception):
    """A source has not given the mesh; the message says why, and the next one is tried."""


class Missing(Failed):
    """The source has no such file."""
