"""A web server on this host for tests: files from memory, and ways in which it fails to send them."""

import http.server
import re
import threading


class Server:
    """files: contents by path. ways: by path "whole" (the default, parts on request), "plain" (neither parts nor a
    version), "short" (half of it, then the connection ends), "short-once", "busy-once", "stall" (half of it, and the
    rest after go()). seen: the path of each request, and its range. parts: how many were answered by a part."""
    def __init__(self):
        self.files, self.ways, self.seen, self.tag, self.parts = {}, {}, [], 1, 0
        self.gate = threading.Event()
        outer = self

        class Handler(http.server.BaseHTTPRequestHandler):
            def log_message(self, *_):
                pass

            def do_GET(self):
                outer.answer(self)

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads = True
        self.address = f"http://127.0.0.1:{self.server.server_address[1]}"

    def __enter__(self):
        threading.Thread(target=self.server.serve_forever, args=(0.02, ), daemon=True).start()
        return self

    def __exit__(self, *_):
        self.gate.set()
        self.server.shutdown()
        self.server.server_close()

    def go(self):
        """Lets stalled answers go on."""
        self.gate.set()
        self.gate = threading.Event()

    def answer(self, request):
        path, gate = request.path, self.gate
        way = self.ways.get(path, "whole")
        wanted = request.headers.get("Range")
        self.seen.append((path, wanted))
        if way.endswith("-once"):
            self.ways[path] = "whole"
        if way == "busy-once" or path not in self.files:
            return request.send_error(503 if path in self.files else 404)
        data, tag, begin = self.files[path], f'"{self.tag}"', 0
        if wanted and request.headers.get("If-Range") == tag and way != "plain":
            begin = int(re.fullmatch(r"bytes=(\d+)-", wanted)[1])
            if begin >= len(data):
                return request.send_error(416)
            request.send_response(206)
            self.parts += 1
            request.send_header("Content-Range", f"bytes {begin}-{len(data) - 1}/{len(data)}")
        else:
            request.send_response(200)
        if way != "plain":
            request.send_header("ETag", tag)
        request.send_header("Content-Length", str(len(data) - begin))
        request.end_headers()
        half = len(data) // 2
        try:
            if way in ("short", "short-once", "stall"):
                request.wfile.write(data[begin:half])
                request.wfile.flush()
                if way != "stall":
                    return None
                gate.wait(30)
                begin = half
            request.wfile.write(data[begin:])
        except OSError:  # the other side has gone
            pass
        return None
