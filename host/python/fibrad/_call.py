# _call.py - one call of the library: threads, progress, signals. SPDX-License-Identifier: MIT
from __future__ import annotations

import contextlib
import signal
import threading
from collections.abc import Callable, Iterator
from typing import Any, Optional

from ._errors import CANCELLED, Cancelled, status_text
from ._structures import Progress as ProgressFunction, Run
from ._values import whole

Progress = Callable[[str, int, int], Any]


@contextlib.contextmanager
def _signals_caught(catch: Callable[[BaseException], None]) -> Iterator[None]:
    """Hands exceptions of signal handlers, such as KeyboardInterrupt, to `catch`. An exception that is raised in a
    callback from C would be printed and lost. Signal handlers run in the main thread only."""
    handlers: dict[int, Any] = {}
    if threading.current_thread() is threading.main_thread():
        found = {number: signal.getsignal(number) for number in signal.valid_signals()}
        handlers = {number: handler for number, handler in found.items() if callable(handler)}

    def guarded(number: int, frame: Any) -> None:
        try:
            handlers[number](number, frame)
        except BaseException as error:
            catch(error)

    for number in handlers:
        signal.signal(number, guarded)
    try:
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)


class Call:
    """Calls of the library. `run` is their fibrad_run. The GIL is released during a call. It is taken up to 20 times a
    second, for signals and for progress."""

    def __init__(self, threads: Optional[int], progress: Optional[Progress]):
        if progress is not None and not callable(progress):
            raise TypeError("progress must be a function of stage, done and total")
        self._progress = progress
        self._raised: Optional[BaseException] = None
        self.run = Run(threads=whole("threads", threads, 1, 1024), progress=ProgressFunction(self._report))

    def _catch(self, error: BaseException) -> None:
        self._raised = self._raised or error

    def guarded(self, function: Callable[[], Any], otherwise: Any) -> Any:
        """What a function of the user returns. An exception is raised after the call, and `otherwise` is returned."""
        try:
            return otherwise if self._raised else function()
        except BaseException as error:
            self._catch(error)
            return otherwise

    def _report(self, context: Any, stage: bytes, done: int, total: int) -> int:
        progress = self._progress
        if progress and self.guarded(lambda: progress(stage.decode(), done, total), False):
            self._raised = Cancelled(status_text(CANCELLED), CANCELLED)
        return self._raised is not None

    def __call__(self, function: Callable[..., int], *arguments: Any) -> int:
        """The status of a call. Raises the exception that a signal handler or a function of the user has raised."""
        self._raised = None
        with _signals_caught(self._catch):
            status = function(*arguments)
        raised, self._raised = self._raised, None
        if raised is not None:
            raise raised
        return status
