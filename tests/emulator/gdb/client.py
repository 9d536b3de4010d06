"""A small client of GDB's remote serial protocol."""

import os
import re
import socket
import subprocess

ROLES = [0, 1, 2, 19, 31, 12, 13, 14, 3, 20, *range(4, 12), *range(21, 31), *range(15, 19)]  # emulator/gdb/registers.h
PC = 32
ENGINE = os.environ.get("TRAX_ENGINE", "fast")


class Client:
    """A trax-sim that waits for its debugger, and the debugger."""

    def __init__(self, sim, *arguments, acknowledge=False):
        self.process = subprocess.Popen([sim, "--gdb", "0", "--engine", ENGINE, *arguments], stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE)
        line = self.process.stderr.readline().decode()
        port = re.fullmatch(r"trax-sim: waiting for GDB: target remote localhost:(\d+)\n", line)
        if not port:
            raise AssertionError(f"no port is named: {line!r}")
        self.socket = socket.create_connection(("127.0.0.1", int(port[1])), timeout=60)
        self.acknowledge = True
        self.console = ""
        self.buffer = b""
        if not acknowledge:
            assert self.ask("QStartNoAckMode") == "OK"
            self.acknowledge = False
        self.features = self.ask("qSupported:swbreak+;hwbreak+;vContSupported+")

    def byte(self):
        if not self.buffer:
            self.buffer = self.socket.recv(65536)
            if not self.buffer:
                raise EOFError("trax-sim has closed the connection")
        byte, self.buffer = self.buffer[:1], self.buffer[1:]
        return byte

    def send(self, data):
        data = data.encode("latin-1")
        self.socket.sendall(b"$" + data + b"#%02x" % (sum(data) % 256))
        if self.acknowledge:
            assert self.byte() == b"+"

    def receive(self):
        while self.byte() != b"$":
            pass
        data, byte = b"", self.byte()
        while byte != b"#":
            data += bytes([self.byte()[0] ^ 0x20]) if byte == b"}" else byte
            byte = self.byte()
        self.byte(), self.byte()
        if self.acknowledge:
            self.socket.sendall(b"+")
        return data.decode("latin-1")

    def ask(self, data):
        self.send(data)
        return self.receive()

    def monitor(self, command):
        self.send("qRcmd," + command.encode().hex())
        text = ""
        while (reply := self.receive()).startswith("O") and reply != "OK":
            text += bytes.fromhex(reply[1:]).decode()
        return text

    def cycle(self):
        return int(self.monitor("cycle"))

    def resume(self, what="vCont;c"):
        """Until the next stop: its kind, its number and its pairs."""
        return parse(self.ask(what))

    def interrupt(self):
        self.socket.sendall(b"\x03")
        return parse(self.receive())

    def register(self, own):
        """By our own number, of the selected thread; "pc" is one."""
        number = PC if own == "pc" else ROLES.index(own)
        return int.from_bytes(bytes.fromhex(self.ask(f"p{number:x}")), "little")

    def set_register(self, own, value):
        number = PC if own == "pc" else ROLES.index(own)
        return self.ask(f"P{number:x}={value.to_bytes(4, 'little').hex()}")

    def read(self, address, size):
        reply = self.ask(f"m{address:x},{size:x}")
        return None if reply.startswith("E") else bytes.fromhex(reply)

    def word(self, address):
        return int.from_bytes(self.read(address, 4), "little")

    def select(self, thread):
        assert self.ask(f"Hg{thread + 1:x}") == "OK"

    def end(self):
        """The program's output, what trax-sim says and its exit status."""
        out, err = self.process.communicate(timeout=60)
        return out.decode(), err.decode(), self.process.returncode


def parse(reply):
    kind, number, rest = reply[0], int(reply[1:3], 16), reply[3:]
    pairs = dict(pair.split(":", 1) for pair in rest.split(";") if pair)
    return kind, number, pairs


def thread_of(stop):
    return int(stop[2]["thread"], 16) - 1
