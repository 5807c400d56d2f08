"""Hybrid dynamical systems: simulation without missing a contact, periodic orbits, bifurcations, grazing.

    import graze
    model = graze.Model.shipped("impact-oscillator", omega=2.8)
    motion = graze.simulate(model, periods=20)
    motion.plot()
"""

from . import _graze
from ._bench import Bench, BenchService, bench
from ._branch import Branch, Curve, Equilibria, Ladder, Orbit, Tori
from ._certificate import Certificate
from ._chatter import Chatter
from ._design import Design, design, design_text, designs
from ._errors import (Error, FileError, InputError, InstrumentError, InternalError, Interrupted, ModelError, OrderError,
                      RunFailed, StudyError, WorkersLost)
from ._estimates import Estimate, Estimates, coupling, decrement, impedance, restitution
from ._experiment import Acquisition, Experiment, acquire
from ._expressions import (Condition, Expression, acos, asin, atan, cos, cosh, erf, exp, expression, log, sin, sinh,
                           sqrt, symbols, tan, tanh)
from ._grazing import CycleMap, Grazing, MapMotion
from ._identification import Identification, Record
from ._layout import ComparedDevice, Layout, LumpedModel, layout, mask_layers
from ._model import Finding, Model, load, models
from ._model_parts import (Conserved, Contact, Contacts, Definition, Event, Friction, Interpolant, Jump, Mode,
                           Parameter, Quantity, Section, Slide, State, Symmetry, Transition, parameters, states)
from ._model_values import Initial, Parameters
from ._motion import Motion
from ._plot import Figure
from ._point import Point
from ._record import HarmonicFit, MeasuredRecord, MeasuredRecords, PeriodFit, read_record
from ._run import Basin, Ensemble, Run, Sweep
from ._runs import basin, curve, ensemble, equilibria, follow, identify, ladder, orbit, record, sweep, torus
from ._simulation import Simulation, simulate
from ._study import Study, points, read_results, run_study, studies
from ._table import Table
from ._tolerance import LocatedSolution, Tolerance
from ._trips import Trips
from ._wafers import Wafers

__version__ = _graze.version

__all__ = [
    "Acquisition", "Basin", "Bench", "BenchService", "Branch", "Certificate", "Chatter", "ComparedDevice",
    "Condition", "Conserved", "Contact", "Contacts", "Curve", "CycleMap", "Definition", "Design", "Ensemble", "Equilibria",
    "Error", "Estimate",
    "Estimates", "Event", "Experiment", "Expression", "Figure", "FileError", "Finding", "Friction", "Grazing",
    "HarmonicFit", "Identification", "Initial", "InputError", "InstrumentError", "InternalError", "Interpolant", "Interrupted",
    "Jump", "Ladder", "Layout", "LocatedSolution", "LumpedModel", "MapMotion", "MeasuredRecord", "MeasuredRecords",
    "Mode", "Model", "ModelError", "Motion", "Orbit", "OrderError", "Parameter", "Parameters", "PeriodFit", "Point",
    "Quantity", "Record", "Run", "RunFailed", "Section", "Simulation", "Slide", "State", "Study", "StudyError",
    "Sweep", "Symmetry", "Table", "Tolerance", "Tori", "Transition", "Trips", "Wafers", "WorkersLost", "acos", "acquire",
    "asin", "atan", "basin", "bench", "cos", "cosh", "coupling", "curve", "decrement", "design", "design_text",
    "designs", "ensemble", "equilibria", "erf", "exp", "expression", "follow", "identify", "impedance", "ladder",
    "layout", "load", "log", "mask_layers", "models", "orbit", "parameters", "points", "read_record",
    "read_results", "record", "restitution", "run_study", "simulate", "sin", "sinh", "sqrt", "states", "studies",
    "sweep", "symbols", "tan", "tanh", "torus",
]
