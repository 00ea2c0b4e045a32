"""What the tests of the user guide have in common: commands and Python of its pages work as they stand."""

import os
import pathlib
import re
import subprocess

from checkout import PROGRAM, ROOT, Folder, program, python


class Guide(Folder):
    """A folder that looks like a clone, and in it the folder ``own``, in which commands and Python of the guide run."""

    def setUp(self):
        super().setUp()
        (self.folder / "data").symlink_to(ROOT / "data")
        (self.folder / "plateau").symlink_to(pathlib.Path(PROGRAM).resolve())
        self.own = self.folder / "own"

    def make_own(self):
        """The folder that the first run makes."""
        self.own.mkdir(exist_ok=True)
        for name in ("data", "plateau"):
            (self.own / name).symlink_to(f"../{name}")

    def plateau(self, *arguments):
        program(*arguments, cwd=self.own)

    def run_blocks(self, document):
        """Runs the Python of a document as a notebook does, all of it one after the other, with the package installed."""
        text = (ROOT / "docs" / document).read_text()
        blocks = re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
        self.assertTrue(blocks, document)
        python("\n".join(blocks), cwd=self.own)

    def walk(self, document, warns=False):
        """Runs the shell blocks of a document, one after the other, in the folder ``own``, or in that of a clone if they make it; gives what
        they said."""
        text = (ROOT / "docs" / document).read_text()
        blocks = re.findall(r"^```sh\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
        makes_own = any("mkdir -p own" in block for block in blocks)
        if not makes_own:
            self.make_own()
        environment = {**os.environ, "PATH": f"{ROOT / 'python/bin'}:{os.environ['PATH']}"}
        place, said = self.folder if makes_own else self.own, ""
        for block in blocks:
            command = ["sh", "-e", "-c", f"{block}\npwd > '{self.folder / '.left'}'"]
            done = subprocess.run(command, cwd=place, env=environment, capture_output=True, text=True, timeout=300)
            self.assertEqual(done.returncode, 0, f"{document}:\n{block}\n{done.stderr}")
            if not warns:
                self.assertNotIn("warning", done.stderr, f"{document}:\n{block}")
            said, place = said + done.stdout + done.stderr, pathlib.Path((self.folder / ".left").read_text().strip())
        self.assertTrue(said, f"{document} has no commands, or they say nothing")
        return said

    def expect_page(self, document, *names, warns=False):
        """Its commands make these files in the folder ``own``, leave all else as it is, and say every line that it shows as what one sees; a
        line that ends with "…" is the beginning of one."""
        lines = self.walk(document, warns).splitlines()
        for shown in re.findall(r"^```console\n(.*?)^```$", (ROOT / "docs" / document).read_text(), re.MULTILINE | re.DOTALL):
            for line in shown.splitlines():
                begin, is_beginning = line.removesuffix(" …"), line.endswith(" …")
                self.assertTrue(any(found.startswith(begin) if is_beginning else found == line for found in lines), f"{document}: {line}")
        for name in names:
            self.assertTrue((self.own / name).exists(), f"{document}: {name}")
        # Git ignores that folder.
        self.assertIn("/own/", (ROOT / ".gitignore").read_text().splitlines())
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), [".left", "data", "own", "plateau"])
