"""The JSON Schema of scenes, as the validator of another house reads it, and the program agree."""

import json
import os
import random
import re
import tomllib
import unittest
from concurrent.futures import ThreadPoolExecutor
from itertools import zip_longest

import jsonschema
from checkout import ROOT, called, changed, program

SCENES = ROOT / "crates/io/tests/scenes"

# Bad scenes that are no mistake of one file's form: what numbers say together, what the machine or this version cannot do, and
# what only the scenes that they extend tell.
FORM_IS_GOOD = {
    "black-is-white",
    "companion-alone",
    "contact-temperature-without-heat",
    "crop-backwards",
    "diameter-of-a-rectangle",
    "extends-a-folder",
    "extends-a-newer",
    "extends-in-a-circle",
    "extends-in-a-circle-too",
    "extends-itself",
    "extends-what-is-not-there",
    "fibre-wider-than-long",
    "filters-crossed",
    "heat-incomplete",
    "heat-without-friction",
    "image-without-pixel",
    "mesh-larger-than-memory",
    "mesh-lengths-incomplete",
    "number-factor-without-heat",
    "pin-longer-than-ring",
    "pin-wider-than-disc",
    "pin-wider-than-ring",
    "pm25-above-pm10",
    "power-law-incomplete",
    "radii-exchanged",
    "round-pin-longer-than-columns",
    "round-pin-round-the-ring",
    "round-pin-wider-than-track",
    "round-pin-without-cells",
    "round-pin-without-diameter",
    "steps-beyond-counting",
    "text-keys-alone",
    "texture-missing",
    "unroll-radii-exchanged",
    "unroll-without-centre",
}
WRONG_TYPES = ["1979-05-27", "[true]", "[[1]]", '""', '" "', "-7"]
# Numbers of any sign.
ACCEPT_MINUS_7 = {f"{body}.{key}" for body in ("disc", "pin") for key in ("prepare.scale", "surface.synthetic.skewness")}
UNITS = "m mm um µm N kN Pa GPa s min m/s km/h rpm rad/s Hz 1/Pa m^2/N mm^3/(N_m) m^2 um^2 kg x deg".split()
# Random values, each of which is tried with every key.
VALUES = 256 if "PLATEAU_LONG" in os.environ else 32
# Keys that are given to the program at a time.
AT_ONCE = 12

SCHEMA = json.loads(program("schema"))
VALIDATOR = jsonschema.Draft7Validator(SCHEMA)


def keys(node=SCHEMA, path=()):
    """Path and schema of every key that has a value."""
    for name, key in node["properties"].items():
        match key:
            case {"properties": _}:
                yield from keys(key, (*path, name))
            # A step of a preparation, which may be "none" as a whole.
            case {"anyOf": [{"properties": _} as table, {"const": "none"} as none]}:
                yield from keys(table, (*path, name))
                yield ".".join((*path, name)), none
            case _ if name != "extends":
                yield ".".join((*path, name)), key


def document(text):
    """What a validator sees of a scene; None if it is not TOML, whose integers have 64 bits."""
    try:
        found = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        return None
    return None if any(abs(number) >= 2**63 for number in integers(found)) else found


def integers(value):
    if isinstance(value, dict | list):
        for entry in value.values() if isinstance(value, dict) else value:
            yield from integers(entry)
    elif isinstance(value, int):
        yield value


def in_toml(value):
    """A value of the schema as scenes have it."""
    return json.dumps(value, ensure_ascii=False)


def accepted(sets):
    """Whether the program and the schema accept these values (path: value in TOML), whatever each needs beside it."""
    # A key that is not there keeps the program from looking at what several keys say together.
    told = called("check", SCENES / "good/minimal.toml", *changed(*(f"{path}={value}" for path, value in sets.items()), "titel=1"))
    assert told.returncode == 2, (sets, told)
    problems = [line for line in told.stderr.splitlines() if "has a meaning only beside" not in line]
    found = {}
    for path, value in sets.items():
        scene = document(f'extends = "minimal.toml"\n{path} = {value}')
        refused = any(f": {path}: " in line for line in problems)
        found[path] = not refused, scene is not None and VALIDATOR.is_valid(scene)
    return found


def rounds():
    """All keys, in groups of which no two are of one table, as those that exclude each other are."""
    tables = {}
    for path, _ in keys():
        tables.setdefault(tuple(path.split(".")[:-1][:2]), []).append(path)
    # Of a scene of a later version the program looks at nothing else.
    for path in tables.pop(()):
        yield [path]
    for group in zip_longest(*tables.values()):
        paths = [path for path in group if path]
        # A message has room for so many problems, whatever they are.
        yield from (paths[at : at + AT_ONCE] for at in range(0, len(paths), AT_ONCE))


def good_value(path, key):
    """A value that a key may have, in TOML: not from its pattern or range but written by hand."""
    match key:
        case {"enum": [first, *_]} | {"const": first}:
            return in_toml(first)
        case {"anyOf": [one, {"const": "none"}]}:
            return good_value(path, {name: value for name, value in (key | one).items() if name != "anyOf"})
        case {"anyOf": _}:
            return {"pitch": '"2 um"', "time_acceleration": "2.5", "workers": "1", "threshold": "0.5"}[path.split(".")[-1]]
        case {"type": "array"}:
            lists = {"maps": '["pressure", "pin_status"]', "maps_at": '["0 s", "2 min"]', "height_range": '["2 um", "2 um"]'}
            lists["points"] = '[["0 s", "4 N", "9 rpm"], ["1 min", "0 N", "0 rpm"]]'
            lists |= dict.fromkeys(("wear_rate_factor", "friction_factor", "number_factor"), '[["-9.5 degC", 2.5], ["300 K", 0]]')
            lists |= dict.fromkeys(("along", "across", "radii"), '["1.5 mm", "4 mm"]') | {"centre": '["4 mm", "-20 mm"]'}
            return lists[path.split(".")[-1]]
        case {"type": "boolean"}:
            return "true"
        case {"type": "integer"}:
            return "1"
        case {"type": "number"}:
            return "2.5" if path.endswith("kurtosis") else "0.5"
        case {"examples": [str(quantity), *_]} if " " in quantity:
            return f'"1.5e1 {quantity.split(" ", 1)[1]}"'
        case {"examples": ["um"]}:
            return '"nm"'
    return '"a text"'


def random_value(chance):
    """A value of any kind, in TOML. Whole numbers are integers: JSON does not tell 8.0 from 8. There is no minus zero."""

    def number():
        if chance.random() < 0.5:
            return str(chance.randrange(-3, 20))
        return str(chance.choice([tenths for tenths in range(-30, 300) if tenths % 10]) / 10)

    def quantity():
        return f'"{number()}{chance.choice(["", " ", "e-3 ", "e2 "])}{chance.choice([*UNITS, ""]).replace("_", " ")}"'

    def word():
        return in_toml(chance.choice(WORDS))

    def plain():
        return chance.choice([number, quantity, quantity, word, lambda: "true", lambda: "false"])()

    if chance.random() < 0.75:
        return plain()
    return "[" + ", ".join(plain() for _ in range(chance.randrange(4))) + "]"


def words(node):
    """Every word that some key may be."""
    match node:
        case {"enum": list(choices)}:
            yield from (word for word in choices if isinstance(word, str))
        case {"const": str(word)}:
            yield word
        case dict():
            for entry in node.values():
                yield from words(entry)
        case list():
            for entry in node:
                yield from words(entry)


WORDS = sorted({*words(SCHEMA), "pressure", "disc_height"})


class SceneSchema(unittest.TestCase):
    def assert_accepted(self, cases, expected=None):
        """Checks that both accept, or refuse, cases of path and value; that they agree on them if nothing is expected."""
        self.assert_all(({path: value} for path, value in cases), expected)

    def assert_all(self, cases, expected=None):
        """The same of several keys at a time."""
        cases = list(cases)
        self.assertGreater(len(cases), 0)
        with ThreadPoolExecutor() as threads:
            for sets, found in zip(cases, threads.map(accepted, cases), strict=True):
                for path, (program, schema) in found.items():
                    wanted = program if expected is None else expected
                    self.assertEqual((program, schema), (wanted, wanted), f"{path} = {sets[path]}: program, schema")

    def test_it_is_a_schema_of_draft_7(self):
        self.assertEqual(SCHEMA["$schema"], "http://json-schema.org/draft-07/schema#")
        jsonschema.Draft7Validator.check_schema(SCHEMA)

    def test_every_good_scene_is_valid(self):
        folders = [SCENES / "good", SCENES / "good/parts", ROOT / "data/scenes", *(ROOT / "tests/vectors").iterdir()]
        for folder in folders:
            for path in folder.glob("*.toml"):
                with self.subTest(path=path):
                    VALIDATOR.validate(document(path.read_text()))

    def test_every_scene_of_bad_form_is_not_valid(self):
        paths = list((SCENES / "bad").glob("*.toml"))
        self.assertLess(FORM_IS_GOOD, {path.stem for path in paths})
        for path in paths:
            with self.subTest(path=path):
                try:
                    scene = document(path.read_bytes().decode())
                except (UnicodeDecodeError, IsADirectoryError):
                    scene = None
                valid = scene is not None and VALIDATOR.is_valid(scene)
                self.assertEqual(valid, path.stem in FORM_IS_GOOD)

    def test_every_piece_of_a_scene_in_the_documentation_is_valid(self):
        count = 0
        for path in (ROOT / "docs").rglob("*.md"):
            for piece in re.findall(r"^```toml\n(.*?)^```", path.read_text(), re.DOTALL | re.MULTILINE):
                # The others are of studies.
                if not any(table in piece for table in ("[[factor]]", "[[response]]", "[fit]")):
                    with self.subTest(path=path, piece=piece):
                        start = "" if "extends" in piece else 'extends = "scene.toml"\n'
                        VALIDATOR.validate(document(start + piece))
                    count += 1
        self.assertGreater(count, 3)

    def test_both_accept_a_good_value_of_every_key(self):
        self.assert_accepted(((path, value) for path, key in keys() for value in [good_value(path, key)]), True)

    def test_both_accept_examples_and_defaults(self):
        cases = ((path, [*key.get("examples", []), *([key["default"]] if "default" in key else [])]) for path, key in keys())
        self.assert_accepted(((path, in_toml(value)) for path, values in cases for value in values), True)

    def test_both_refuse_wrong_types(self):
        cases = [(path, value) for path, _ in keys() for value in WRONG_TYPES]
        good = [(path, value) for path, value in cases if value == "-7" and path in ACCEPT_MINUS_7]
        self.assertEqual(len(good), len(ACCEPT_MINUS_7))
        self.assert_accepted(good, True)
        self.assert_accepted([case for case in cases if case not in good], False)

    def test_both_refuse_keys_that_are_not_there(self):
        paths = ["mesh.row", "pin.prepare.syntetic", "disc.surface.synthetic.sed", "pin.base.flat", "titel", "meshes"]
        self.assert_accepted(((path, "1") for path in paths), False)

    def test_they_agree_on_random_values(self):
        chance = random.Random(20261122)
        groups = list(rounds())
        values = [random_value(chance) for _ in range(VALUES)]
        self.assert_all(dict.fromkeys(group, value) for value in values for group in groups)
