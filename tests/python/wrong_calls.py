"""Calls every public function, class and method of graze with what it cannot use: other types, sizes, NaN, huge, negative
and empty values, other objects, objects without content, from several threads. Each call has to return or to raise an
ordinary exception; a crash ends this process, and what takes too long is interrupted and counted as wrong.

usage: python3 wrong_calls.py [CALLS [SEED]]

Prints the number of calls and what was wrong; the last call is in the file `last_call` of the present folder.
"""

import collections
import contextlib
import copy
import decimal
import faulthandler
import gc
import inspect
import io
import math
import os
import pickle
import random
import shutil
import signal
import sys
import tempfile
import threading
import time
import warnings

import numpy

import graze

SECONDS = 5  # in which a wrong call has to end
# What a call may raise. A SystemError, NameError, AssertionError or RuntimeError would be a mistake of the package.
ORDINARY = (graze.Error, TypeError, ValueError, KeyError, IndexError, AttributeError, OverflowError, ZeroDivisionError,
            ImportError, OSError, RecursionError, MemoryError, pickle.PicklingError, StopIteration, graze.Interrupted)
WRONG = (graze.InternalError, UnboundLocalError)


class Strange:
    """Has all that numbers, texts and sequences have, and fails in each."""

    def fail(self, *arguments):
        raise ArithmeticError("strange")

    __float__ = __int__ = __index__ = __len__ = __iter__ = __getitem__ = __fspath__ = __bool__ = __hash__ = __eq__ = fail
    tolist = items = keys = fail


class Liar:
    """Says that it is large."""

    def __len__(self):
        return 2**62

    def __getitem__(self, index):
        if index > 3:
            raise IndexError
        return index

    def __index__(self):
        return 10**30

    def __fspath__(self):
        return "\0"


def nested(depth):
    value = []
    for _ in range(depth):
        value = [value]
    return value


def itself():
    value = []
    value.append(value)
    return value


def junk(good):
    """Values of which none is what is wanted, made anew for each call."""
    return [
        lambda: None, lambda: True, lambda: -1, lambda: 0, lambda: 1.5, lambda: math.nan, lambda: math.inf,
        lambda: -math.inf, lambda: 1e308, lambda: 5e-324, lambda: 2**31, lambda: 2**63, lambda: 2**64, lambda: -(2**63),
        lambda: 10**400, lambda: "", lambda: "x", lambda: "nowhere", lambda: "\0", lambda: "a\nb", lambda: "\ud800",
        lambda: "ä∞" * 50, lambda: "(" * 5000, lambda: "x" * 100_000, lambda: "1e999", lambda: "../..", lambda: "{}%s\\",
        lambda: b"bytes", lambda: bytearray(3), lambda: [], lambda: [1], lambda: [math.nan, 1.0], lambda: ["x"],
        lambda: [[]], lambda: [None], lambda: nested(50), lambda: nested(800), itself, lambda: (), lambda: (1, 2, 3),
        lambda: (2.7, 2.8, 10**15), lambda: (2.7, math.nan, 3), lambda: (2.7, 2.8, -3), lambda: {}, lambda: {"x": math.nan},
        lambda: {1: 2}, lambda: {"omega": (1, 2)}, lambda: {"omega": (2.7, 2.8, 10**15)}, lambda: {"omega": "x"},
        lambda: {"": 1}, lambda: {"omega": nested(100)}, lambda: {"nowhere": 1}, lambda: {"omega": 10**400},
        lambda: {None: None}, set, lambda: frozenset("ab"), object, lambda: len, lambda: type, lambda: Ellipsis,
        lambda: complex(1, 1), lambda: numpy.array([]), lambda: numpy.zeros((2, 3)), lambda: numpy.array(["a"]),
        lambda: numpy.array([None]), lambda: numpy.float32(1), lambda: numpy.int64(-5), lambda: numpy.array(math.nan),
        lambda: numpy.zeros((0, 3)), lambda: numpy.zeros(3)[::-2], lambda: decimal.Decimal("NaN"), lambda: range(3),
        lambda: iter([]), lambda: (one for one in "ab"), Strange, Liar, lambda: lambda *one: 1 / 0, lambda: io.StringIO(),
        lambda: slice(None), lambda: NotImplemented,
        *(lambda value=value: value for value in good.values()),
    ]


def things():
    """Objects whose methods are called, and good values of arguments."""
    model = graze.Model.shipped("impact-oscillator", omega=2.8)
    x, v = graze.symbols("x v")
    simulation = graze.Simulation(model, extrema="x", sections="phase0")
    motion = simulation.run(periods=3, dense=True)
    sweep = graze.sweep(model, vary={"omega": [2.7, 2.75]}, cycles=60)
    orbit = graze.orbit(model, set={"omega": 4}, from_={"x": -0.07})
    branch = orbit.follow(omega=(2.7, 4.5), direction="down", steps=60)
    branch.save("branch.sqlite")
    study = graze.read_results("branch.sqlite")
    good = {"model": model, "x": x, "condition": x > 0, "simulation": simulation, "motion": motion, "table": motion.samples,
            "sweep": sweep, "orbit": orbit, "branch": branch, "point": branch[0], "study": study,
            "parameters": model.parameters, "initial": model.initial,
            "ensemble": graze.ensemble(model, vary={"omega": [2.7, 2.75]}, periods=2, skip={"periods": 3}),
            "basin": graze.basin(model, vary={"x": [-1.0, -0.5], "v": [0.0, 0.1]}, cycles=60)}
    with contextlib.suppress(Exception):
        good["grazing"] = branch["GR1"]
    good["error"] = graze.InputError("a", "b")
    # A run whose file was deleted, and a file with other bytes in its middle.
    good["gone"] = graze.sweep(model, vary={"omega": [2.7]}, cycles=60)
    shutil.rmtree(os.path.dirname(good["gone"]._store.file.path))
    good["damaged"] = graze.read_results("branch.sqlite")
    with contextlib.suppress(graze.Error):
        branch.save("damaged.sqlite")
        with open("damaged.sqlite", "r+b") as file:
            file.seek(5000)
            file.write(bytes(range(256)) * 40)
        good["damaged"] = graze.read_results("damaged.sqlite")
    return good


def raw(kind):
    """An object of a class that was not initialised, if that is possible."""
    with contextlib.suppress(Exception):
        return kind.__new__(kind)
    return None


SKIPPED = {"__new__", "__init_subclass__", "__subclasshook__", "__class__", "__del__", "__getattribute__", "__setattr__",
           "__delattr__", "__init__", "__dict__", "__weakref__", "__module__", "__doc__", "__annotations__",
           "__sizeof__", "__dir__", "__post_init__", "__match_args__", "__dataclass_fields__", "__dataclass_params__",
           "__slots__", "__abstractmethods__", "__orig_bases__", "__parameters__"}


def names_of(thing):
    return [name for name in dir(type(thing)) if name not in SKIPPED and (name[0] != "_" or name.startswith("__"))]


def targets(good):
    """(label, function) of everything public that can be called; properties are read."""
    found = []
    for name in sorted(dir(graze)):
        if not name.startswith("_") and callable(getattr(graze, name)):
            found.append((f"graze.{name}", getattr(graze, name)))
    empty = [(f"empty {name}", raw(getattr(graze, name))) for name in dir(graze) if inspect.isclass(getattr(graze, name))]
    compiled = [(f"empty _graze.{name}", raw(getattr(graze._graze, name))) for name in dir(graze._graze)
                if inspect.isclass(getattr(graze._graze, name))]
    for label, thing in [*good.items(), *empty, *compiled]:
        if thing is None:
            continue
        for name in names_of(thing):
            attribute = inspect.getattr_static(type(thing), name, None)
            if isinstance(attribute, property):
                found.append((f"{label}.{name}", lambda *_, thing=thing, name=name, **__: getattr(thing, name)))
            elif callable(attribute) or isinstance(attribute, (staticmethod, classmethod)):
                found.append((f"{label}.{name}", lambda *a, thing=thing, name=name, **k: getattr(thing, name)(*a, **k)))
    return found


# Good values of arguments by name, so that calls with one wrong argument come further than to the first check.
def good_arguments(good):
    return {"model": good["model"], "point": good["point"], "vary": {"omega": [2.7]}, "path": "branch.sqlite",
            "time": 0.5, "names": "x v", "text": "x + 1", "name": "x", "output": "out", "times": 0.5,
            "name_or_file": "impact-oscillator", "sql": "select 1", "what": "points", "chosen": slice(0, 1)}


def arguments_for(function, values, chance, known):
    """Positional and keyword arguments, of which one or more are wrong."""
    try:
        parameters = list(inspect.signature(function).parameters.values())
    except (ValueError, TypeError):
        parameters = []
    positional, words = [], {}
    names = [one for one in parameters if one.kind in (one.POSITIONAL_OR_KEYWORD, one.KEYWORD_ONLY, one.POSITIONAL_ONLY)]
    if not names or chance.random() < 0.25:
        positional = [chance.choice(values)() for _ in range(chance.randrange(4))]
    else:
        wrong = set(chance.sample(range(len(names)), k=min(len(names), chance.choice((1, 1, 1, 2, 3)))))
        for i, one in enumerate(names):
            if i in wrong:
                words[one.name] = chance.choice(values)()
            elif one.default is one.empty and one.name in known:
                words[one.name] = known[one.name]
    if chance.random() < 0.15:
        words[chance.choice(("nonsense", "kind", "model", "threads", "progress", "x", "omega", "self", "cycles", "from_",
                             "set", "executor", "start", "axes"))] = chance.choice(values)()
    return positional, words


class TooLong(BaseException):
    pass


def short(value):
    try:
        text = repr(value)
    except BaseException as error:  # such as that of an object without content
        text = f"<{type(value).__name__}, repr raises {type(error).__name__}>"
    return text if len(text) < 120 else text[:100] + "..."


class Caller:
    def __init__(self, chance, good, log=None):
        self.chance, self.log = chance, log
        self.values, self.known = junk(good), good_arguments(good)
        self.outcomes, self.problems = collections.Counter(), []

    def call(self, label, function):
        target = function
        if "." in label and not label.startswith("graze."):
            # A method is called through a lambda: its own signature says what it takes.
            thing, name = function.__kwdefaults__["thing"], function.__kwdefaults__["name"]
            attribute = inspect.getattr_static(type(thing), name, None)
            target = attribute if isinstance(attribute, property) else getattr(type(thing), name, function)
        positional, words = arguments_for(target, self.values, self.chance, self.known)
        words.pop("self", None)
        told = f"{label}({', '.join([*map(short, positional), *(f'{k}={short(w)}' for k, w in words.items())])})"
        if self.log:
            self.log.seek(0)
            self.log.truncate()
            self.log.write(told)
            self.log.flush()
        begun = time.monotonic()
        try:
            result = function(*positional, **words)
            if self.chance.random() < 0.3:
                short(result)
            self.outcomes["returned"] += 1
        except WRONG as error:
            self.problems.append(f"{told}: {type(error).__name__}: {short(error)}")
        except ORDINARY as error:
            self.outcomes[type(error).__name__] += 1
            try:
                str(error)
            except Exception as second:
                self.problems.append(f"{told}: str of {type(error).__name__} raises {second!r}")
        except TooLong:
            self.problems.append(f"{told}: takes too long")
        except ArithmeticError as error:  # by Strange, or by a function among the values
            self.outcomes[type(error).__name__] += 1
        except Exception as error:
            self.problems.append(f"{told}: {type(error).__name__}: {short(error)}")
        if time.monotonic() - begun > SECONDS + 2:
            self.problems.append(f"{told}: has taken {time.monotonic() - begun:.1f} s")


def main() -> int:
    output, sys.stdout = sys.stdout, io.StringIO()
    with tempfile.TemporaryDirectory() as folder, open("last_call", "w", encoding="utf-8",
                                                       errors="backslashreplace") as log:
        os.chdir(folder)
        told, problems = call_all(log)
        os.chdir("/")
    for line in [*told, *(f"WRONG {problem}" for problem in problems), f"{len(problems)} wrong"]:
        print(line.encode("ascii", "backslashreplace").decode(), file=output, flush=True)
    return 1 if problems else 0


def call_all(log):
    """Does all calls. Returns lines that say how many there were, and the problems."""
    calls, seed = (int(one) for one in (sys.argv[1:] + ["2000", "1"][len(sys.argv) - 1:])[:2])
    faulthandler.enable()
    warnings.simplefilter("ignore")
    os.environ["MPLBACKEND"] = "Agg"
    chance = random.Random(seed)
    good = things()
    everything = targets(good)

    def ring(number, frame):
        raise TooLong

    signal.signal(signal.SIGALRM, ring)
    caller = Caller(chance, good, log)
    order = [everything[i % len(everything)] for i in range(calls)]
    chance.shuffle(order)
    for number, (label, function) in enumerate(order):
        faulthandler.dump_traceback_later(60, exit=True)  # for what cannot be interrupted
        signal.setitimer(signal.ITIMER_REAL, SECONDS)
        try:
            caller.call(label, function)
        except TooLong:
            caller.problems.append(f"{label}: takes too long")
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
        if number % 100 == 0:
            if "matplotlib.pyplot" in sys.modules:
                sys.modules["matplotlib.pyplot"].close("all")
            gc.collect()
    faulthandler.cancel_dump_traceback_later()

    # From several threads at once, on the same objects: what is quick.
    quick = [one for one in everything if one[0].split(".")[0] in ("model", "x", "condition", "simulation", "motion", "table",
                                                                   "parameters", "initial", "error")
             and not one[0].endswith((".plot", ".run", ".save", ".figure", "._repr_html_"))]
    callers = [Caller(random.Random(seed + number), copy.copy(good)) for number in range(1, 4)]

    def many(one):
        for _ in range(calls // 10):
            one.call(*one.chance.choice(quick))

    faulthandler.dump_traceback_later(300, exit=True)
    threads = [threading.Thread(target=many, args=(one,)) for one in callers]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    faulthandler.cancel_dump_traceback_later()

    outcomes = sum((one.outcomes for one in [caller, *callers]), collections.Counter())
    problems = [problem for one in [caller, *callers] for problem in one.problems]
    lines = [f"{sum(outcomes.values()) + len(problems)} calls of {len(everything)} functions and methods"]
    lines += [f"  {name}: {count}" for name, count in outcomes.most_common()]
    return lines, problems


if __name__ == "__main__":
    sys.exit(main())
