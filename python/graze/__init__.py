"""Hybrid dynamical systems: simulation without missing a contact, periodic orbits, bifurcations, grazing.

    import graze
    model = graze.Model.shipped("impact-oscillator", omega=2.8)
    motion = graze.simulate(model, periods=20)
    motion.plot()
"""

from . import _graze
from ._design import Design, design, design_text, designs
from ._analyses import (Certificate, Chatter, CycleMap, Grazing, LocatedSolution, MapMotion, Tolerance, Trips,
                        points)
from ._errors import (Error, FileError, InputError, InstrumentError, InternalError, Interrupted, ModelError, OrderError,
                      RunFailed, StudyError, WorkersLost)
from ._experiment import Acquisition, Bench, BenchService, Experiment, acquire, bench
from ._expressions import (Condition, Expression, acos, asin, atan, cos, cosh, erf, exp, expression, log, sin, sinh,
                           sqrt, symbols, tan, tanh)
from ._layout import ComparedDevice, Layout, LumpedModel, Wafers, layout, mask_layers
from ._model import Finding, Initial, Model, Parameters, load, models
from ._motion import Motion, Simulation, simulate
from ._plot import Figure
from ._record import (Estimate, Estimates, HarmonicFit, MeasuredRecord, MeasuredRecords, PeriodFit, coupling, decrement,
                      impedance, read_record, restitution)
from ._runs import (Basin, Branch, Curve, Ensemble, Identification, Ladder, Orbit, Point, Record, Run, Study, Sweep, basin,
                    curve, ensemble, follow, identify, ladder, orbit, read_results, record, run_study, studies, sweep)
from ._table import Table
from ._written_model import (Definition, Event, Jump, Mode, Parameter, Quantity, Section, State, Symmetry, Transition,
                             parameters, states)

__version__ = _graze.version

__all__ = [
    "Acquisition", "Basin", "Bench", "BenchService", "Branch", "Certificate", "Chatter", "ComparedDevice",
    "Condition", "Curve", "CycleMap", "Definition", "Design", "Ensemble", "Error", "Estimate", "Estimates", "Event",
    "Experiment", "Expression", "Figure", "FileError", "Finding", "Grazing", "HarmonicFit", "Identification",
    "Initial", "InputError", "InstrumentError", "InternalError", "Interrupted", "Jump", "Ladder", "Layout",
    "LocatedSolution", "LumpedModel", "MapMotion", "MeasuredRecord", "MeasuredRecords", "Mode", "Model",
    "ModelError", "Motion", "Orbit", "OrderError", "Parameter", "Parameters", "PeriodFit", "Point", "Quantity",
    "Record", "Run", "RunFailed", "Section", "Simulation", "State", "Study", "StudyError", "Sweep", "Symmetry",
    "Table", "Tolerance", "Transition", "Trips", "Wafers", "WorkersLost", "acos", "acquire", "asin", "atan",
    "basin", "bench", "cos", "cosh", "coupling", "curve", "decrement", "design", "design_text", "designs",
    "ensemble", "erf", "exp", "expression", "follow", "identify", "impedance", "ladder", "layout", "load", "log",
    "mask_layers", "models", "orbit", "parameters", "points", "read_record", "read_results", "record",
    "restitution", "run_study", "simulate", "sin", "sinh", "sqrt", "states", "studies", "sweep", "symbols", "tan",
    "tanh",
]
