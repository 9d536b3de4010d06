"""Runs a command with a limit for the size of files: file_size_limit.py BYTES COMMAND..."""

import os
import resource
import signal
import sys

limit = int(sys.argv[1])
resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # inherited: write() fails instead
os.execv(sys.argv[2], sys.argv[2:])
