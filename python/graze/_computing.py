"""How runs are carried out: by how many threads, or by which executor, and who is told."""

from __future__ import annotations

from typing import Any, List, Optional

from ._arguments import number_of_threads
from ._progress import Progress, check_progress, telling


class Ways:
    """By what a run is computed. Arguments are checked here, before the run is kept."""

    def __init__(self, threads: Optional[int] = None, progress: Progress = None, executor: Any = None) -> None:
        self.threads = number_of_threads(threads)
        check_progress(progress)
        self.progress = progress
        self.executor = executor
        if executor is not None:
            from ._executors import check_executor

            check_executor(executor)


def carried_out(study: Any, file: Any, only: List[str], ways: Ways) -> List[Any]:
    """Carries out runs of a compiled study. Returns reports."""
    from ._executors import handed_out

    with telling(ways.progress, "point") as told, handed_out(ways.executor, told) as (parts, look):
        return list(study.run(file, threads=ways.threads, only=only, told=look, parts=parts))
