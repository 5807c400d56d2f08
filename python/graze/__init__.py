"""Hybrid dynamical systems: simulation without missing a contact, periodic orbits, bifurcations, grazing.

    import graze
    model = graze.Model.shipped("impact-oscillator", omega=2.8)
    motion = graze.simulate(model, periods=20)
    motion.plot()
"""

from . import _graze
from ._errors import (Error, FileError, InputError, InstrumentError, InternalError, Interrupted, ModelError, OrderError,
                      RunFailed, StudyError)
from ._expressions import (Condition, Expression, acos, asin, atan, cos, cosh, erf, exp, expression, log, sin, sinh,
                           sqrt, symbols, tan, tanh)
from ._model import Model, load, models
from ._motion import Motion, Simulation, simulate
from ._runs import (Basin, Branch, Curve, Ensemble, Ladder, Orbit, Point, Run, Study, Sweep, basin, curve, ensemble,
                    follow, ladder, orbit, read_results, run_study, studies, sweep)
from ._table import Table

__version__ = _graze.version
