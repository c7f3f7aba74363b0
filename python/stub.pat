# Completes nanobind's stub: the module makes its exception without a binding.

_sundog.__suffix__:
    class Error(RuntimeError):
        """What the library refuses or cannot do."""
        kind: str
        file: str
        place: str
        reason: str
        log: str
        status: int
