"""What the user sees of a sweep on standard error: a bar on a terminal, a line now and then elsewhere, what failed."""
import sys
import time

from .store import WRONG_SCENE

_WIDTH = 40
_BAR_INTERVAL = 0.1    # [s]
_LINE_INTERVAL = 30.0  # [s]
_MOST_FAILURES = 20    # that are printed


class Report:
    def __init__(self, layout, stream=sys.stderr):
        self._layout = layout
        self._stream = stream
        self._is_terminal = stream.isatty()
        self._failures = 0
        self.begin(0)

    def begin(self, done_before):
        """The work begins, which is timed from here. done_before: how many samples the store had already."""
        self._before = self.done = done_before
        self._start = self._last = time.monotonic()

    @property
    def seconds(self):
        return time.monotonic() - self._start

    @property
    def new(self):
        """Samples that were simulated now."""
        return self.done - self._before

    def chunk_done(self, chunk, failures):
        self.done += len(self._layout.samples_of(chunk))
        for sample, status, message in failures:
            self._failures += 1
            if self._failures <= _MOST_FAILURES:
                self.line(f'sample {sample}: {"scene" if status == WRONG_SCENE else "simulation"}: {message}')
            elif self._failures == _MOST_FAILURES + 1:
                self.line('more failures are not listed here; see status and message in the store')
        self._show()

    def waiting(self):
        self.line('no worker has come to the scheduler yet; waiting')

    def line(self, text):
        self.clear()
        print(text, file=self._stream, flush=True)

    def clear(self):
        if self._is_terminal:
            self._stream.write('\r\x1b[K')
            self._stream.flush()

    def _show(self):
        now = time.monotonic()
        if now - self._last < (_BAR_INTERVAL if self._is_terminal else _LINE_INTERVAL):
            return
        self._last = now
        samples = self._layout.samples
        left = (samples - self.done) * self.seconds / self.new
        text = f'{100 * self.done // samples:3d} %  {self.done} of {samples} samples, {left:.3g} s left'
        if self._is_terminal:
            filled = _WIDTH * self.done // samples
            self._stream.write(f'\r[{"#" * filled}{"." * (_WIDTH - filled)}] {text} \x1b[K')
            self._stream.flush()
        else:
            self.line(text)
