"""A web server on this host for tests: files from memory, and ways in which it fails to send them."""

import http.server
import threading


class Server:
    """files: contents by path. ways: by path "whole" (the default), "short" (half of it, then the connection ends),
    "short-once", "busy-once", "stall" (half of it, and the rest after `go`). seen: the path of each request."""
    def __init__(self):
        self.files, self.ways, self.seen, self.go = {}, {}, [], threading.Event()
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
        self.go.set()
        self.server.shutdown()
        self.server.server_close()

    def answer(self, request):
        path = request.path
        way = self.ways.get(path, "whole")
        self.seen.append(path)
        if way.endswith("-once"):
            self.ways[path] = "whole"
        if way == "busy-once" or path not in self.files:
            return request.send_error(503 if path in self.files else 404)
        data = self.files[path]
        request.send_response(200)
        request.send_header("Content-Length", str(len(data)))
        request.end_headers()
        half = len(data) // 2
        try:
            if way != "whole":
                request.wfile.write(data[:half])
                request.wfile.flush()
                data = data[half:] if way == "stall" else b""
            if way == "stall":
                self.go.wait(30)
            request.wfile.write(data)
        except OSError:  # the client has gone
            pass
        return None
