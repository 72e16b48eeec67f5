"""Files that are there when they are whole, and else as they were; as cable_sim writes them."""
import contextlib
import os
import signal
import stat


@contextlib.contextmanager
def stopped_by_signals():
    """SIGTERM and SIGHUP raise KeyboardInterrupt, as SIGINT does; what is ignored stays ignored."""
    def stop(number, _):
        raise KeyboardInterrupt(signal.Signals(number).name)
    names = [s for s in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP) if signal.getsignal(s) != signal.SIG_IGN]
    before = {s: signal.signal(s, stop) for s in names}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def why_not_writable(path):
    """Why a file cannot be written, as far as can be said without touching it; empty if it seems that it can."""
    try:
        kind = os.stat(path).st_mode
    except FileNotFoundError:
        directory = os.path.dirname(os.path.realpath(path))
        if not os.path.isdir(directory):
            return 'No such file or directory'
        return '' if os.access(directory, os.W_OK | os.X_OK) else 'no file can be made in its directory'
    except OSError as error:
        return error.strerror
    if _descriptor(path) is not None:
        return ''
    for test, words in ((stat.S_ISDIR, 'Is a directory'), (stat.S_ISFIFO, 'it is a named pipe'), (stat.S_ISSOCK, 'it is a socket'),
                        (stat.S_ISBLK, 'it is a disk')):
        if test(kind):
            return words
    if not os.access(path, os.W_OK):
        return 'Permission denied'
    if stat.S_ISREG(kind) and not os.access(os.path.dirname(os.path.realpath(path)), os.W_OK | os.X_OK):
        return 'no file can be made in its directory'
    return ''


def is_standard_output(path):
    return _descriptor(path) == 1


@contextlib.contextmanager
def written_whole(path):
    """A text file to write to, written aside and renamed at the end of the block; an exception leaves what was there. Until then it
    has no name, so that nothing is left of it whatever ends the program; on file systems that do not know such files it is
    NAME.PID-N.part beside it. Links are followed and stay; permissions stay. Devices, and streams that are open already
    (/dev/stdout), are written directly. Raises OSError."""
    problem = why_not_writable(path)
    if problem:
        raise OSError(f'cannot write {path!r}: {problem}; allowed: a file in a directory that can be written, or a device')
    descriptor = _descriptor(path)
    if descriptor is not None or (os.path.exists(path) and not os.path.isfile(path)):
        with open(os.dup(descriptor) if descriptor is not None else path, 'w', encoding='utf-8') as file:
            yield file
        return
    target = os.path.realpath(path)
    directory = os.path.dirname(target)
    folder = os.open(directory, os.O_PATH | os.O_DIRECTORY | os.O_CLOEXEC)
    part = None
    try:
        descriptor = _open_nameless(directory)
        if descriptor is None:
            part = _new_part(target)
        with open(part if descriptor is None else descriptor, 'w' if part is None else 'x', encoding='utf-8') as file:
            _keep_owner_and_mode(file.fileno(), target)
            yield file
            file.flush()
            os.fsync(file.fileno())
            if part is None:
                part = _new_part(target)
                # With a directory to start from, Python follows the link.
                os.link(f'/proc/self/fd/{file.fileno()}', os.path.basename(part), dst_dir_fd=folder)
        os.replace(part, target)
    except BaseException:
        if part is not None:
            with contextlib.suppress(FileNotFoundError):
                os.remove(part)
        raise
    finally:
        os.close(folder)


def _open_nameless(directory):
    """A file that the system removes with the process that has it open; None where there is no such thing, or no way to name it."""
    if not os.path.isdir('/proc/self/fd'):
        return None
    try:
        return os.open(directory, os.O_TMPFILE | os.O_WRONLY | os.O_CLOEXEC, 0o666)
    except OSError:
        return None


def _descriptor(path):
    """The number of a stream that is open already, else None."""
    for _ in range(40):
        directory, name = os.path.split(path)
        directory = os.path.realpath(directory)
        if directory == f'/proc/{os.getpid()}/fd' and name.isdigit():
            return int(name)
        path = os.path.join(directory, name)
        if not os.path.islink(path):
            return None
        path = os.path.join(directory, os.readlink(path))
    return None


def _new_part(target):
    directory, name = os.path.split(target)
    start = os.path.join(directory, f'{name[:60]}.{os.getpid()}')
    number = 0
    while os.path.lexists(f'{start}-{number}.part'):
        number += 1
    return f'{start}-{number}.part'


def _keep_owner_and_mode(descriptor, target):
    try:
        status = os.stat(target)
    except FileNotFoundError:
        return
    with contextlib.suppress(PermissionError):  # only root may give a file away
        os.fchown(descriptor, status.st_uid, status.st_gid)
    os.fchmod(descriptor, stat.S_IMODE(status.st_mode))
