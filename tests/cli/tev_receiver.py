"""A viewer without a window: accepts the tev viewer's packets, strictly, and keeps the picture."""

import socket
import struct
import threading
import time

CREATE_IMAGE, UPDATE_IMAGE_V2 = 4, 5


class BadPacket(Exception):
    pass


class Packet:
    """The fields of one packet; what is missing, left over or no such value is a BadPacket."""

    def __init__(self, body):
        self._body, self._at = body, 0

    def take(self, size):
        if self._at + size > len(self._body):
            raise BadPacket(f"needs {size} bytes at {self._at} of {len(self._body)}")
        self._at += size
        return self._body[self._at - size : self._at]

    def byte(self):
        return self.take(1)[0]

    def boolean(self):
        value = self.byte()
        if value > 1:
            raise BadPacket(f"a bool is {value}")
        return value == 1

    def integer(self):
        return struct.unpack("<i", self.take(4))[0]

    def text(self):
        end = self._body.find(b"\0", self._at)
        if end < 0:
            raise BadPacket("a string does not end")
        return self.take(end + 1 - self._at)[:-1].decode()

    def end(self):
        if self._at != len(self._body):
            raise BadPacket(f"{len(self._body) - self._at} bytes too many")


class Picture:
    def __init__(self, packet):
        self.width, self.height = packet.integer(), packet.integer()
        self.channels = [packet.text() for _ in range(packet.integer())]
        packet.end()
        if not (0 < self.width <= 1 << 15 and 0 < self.height <= 1 << 15):
            raise BadPacket(f"a picture of {self.width}x{self.height}")
        if not self.channels or len(set(self.channels)) != len(self.channels):
            raise BadPacket(f"channels {self.channels}")
        self.planes = {c: bytearray(4 * self.width * self.height) for c in self.channels}
        self.updates = 0

    def update(self, packet):
        channels = [packet.text() for _ in range(packet.integer())]
        x, y, width, height = (packet.integer() for _ in range(4))
        if not set(channels) <= set(self.channels) or not channels:
            raise BadPacket(f"update of channels {channels}, there are {self.channels}")
        if x < 0 or y < 0 or width < 1 or height < 1 or x + width > self.width or y + height > self.height:
            raise BadPacket(f"update of {width}x{height} at {x},{y} in {self.width}x{self.height}")
        for channel in channels:
            for row in range(y, y + height):
                at = 4 * (row * self.width + x)
                self.planes[channel][at : at + 4 * width] = packet.take(4 * width)
        packet.end()
        self.updates += 1

    def pixels(self, window=None):
        """channel -> bytes, as Exr.pixels() gives them."""
        x0, y0, x1, y1 = window or (0, 0, self.width, self.height)
        return {
            c: b"".join(bytes(plane[4 * (y * self.width + x0) : 4 * (y * self.width + x1)]) for y in range(y0, y1))
            for c, plane in self.planes.items()
        }


class TevReceiver:
    """Listens from the start; `viewer` is called with one connection after the other."""

    def __init__(self, viewer=None, host="127.0.0.1", port=0, buffer=None):
        self.pictures = {}
        self.errors = []
        self.connections = 0
        self._viewer = viewer or TevReceiver.read_all
        self._last = None
        self._closing = threading.Event()
        self._family = socket.AF_INET6 if ":" in host else socket.AF_INET
        self._listener = socket.socket(self._family)
        self._listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if buffer:
            self._listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer)
        self._listener.bind((host, port))
        self._listener.listen()
        self.port = self._listener.getsockname()[1]
        self.address = f"[{host}]:{self.port}" if ":" in host else f"{host}:{self.port}"
        self._thread = threading.Thread(target=self._accept, daemon=True)
        self._thread.start()

    def close(self):
        """Waits until what was sent has been read; once is enough."""
        if self._closing.is_set():
            return
        self._closing.set()
        with socket.socket(self._family) as last:  # behind every connection that waits to be accepted
            last.bind((self._listener.getsockname()[0], 0))
            self._last = last.getsockname()[1]
            last.connect(self._listener.getsockname())
            self._thread.join(20)
        self._listener.close()

    def _accept(self):
        while True:
            connection, peer = self._listener.accept()
            with connection:
                if peer[1] == self._last:
                    return
                self.connections += 1
                try:
                    self._viewer(self, connection)
                except ConnectionError:
                    pass
                except Exception as error:  # for the test's thread to look at
                    self.errors.append(error)

    def packets(self, connection):
        """Each packet's body, without its size, until the other side closes between two packets."""
        with connection.makefile("rb") as stream:
            while head := stream.read(4):
                (size,) = struct.unpack("<I", head)
                if not 5 < size <= 1 << 28:
                    raise BadPacket(f"a packet of {size} bytes")
                body = stream.read(size - 4)
                if len(body) != size - 4:
                    raise BadPacket(f"the connection ends {size - 4 - len(body)} bytes before its packet")
                yield body

    def take_in(self, body):
        packet = Packet(body)
        kind = packet.byte()
        packet.boolean()
        name = packet.text()
        if kind == CREATE_IMAGE:
            self.pictures[name] = Picture(packet)
        elif kind == UPDATE_IMAGE_V2:
            if name not in self.pictures:
                raise BadPacket(f"update of '{name}', which nobody created")
            self.pictures[name].update(packet)
        else:
            raise BadPacket(f"a packet of type {kind}")

    def read_all(self, connection):
        for body in self.packets(connection):
            self.take_in(body)

    def read_slowly(self, connection):
        for body in self.packets(connection):
            self.take_in(body)
            time.sleep(0.02)

    def sleep_then_read(self, connection):
        time.sleep(1)
        self.read_all(connection)

    def hang(self, connection):
        self._closing.wait()

    def close_at_once(self, connection):
        pass

    def die_once(self, connection):
        """Breaks off the first connection after some packets, in the middle of one; reads later ones."""
        if self.connections > 1:
            return self.read_all(connection)
        for _, body in zip(range(5), self.packets(connection)):
            self.take_in(body)
        self.pictures.clear()
        connection.recv(100)
        # The close is a reset, as that of a program that crashed.
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
