"""Runs about measured records: reading them, and parameters that are found from them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict

from ._model import Model
from ._run import Run
from ._table import Table

if TYPE_CHECKING:
    import numpy


class Record(Run):
    """Measured records: a point for each record, its rows as `samples`."""

    kind = "record"

    def __len__(self) -> int:
        return int(self._store.read("count", self.name))

    def __bool__(self) -> bool:
        return True

    def __repr__(self) -> str:
        count = len(self)
        values = ", ".join(name for name, _ in self._record["values"])
        return f"<Record {self.name}: {count} {'record' if count == 1 else 'records'} of {values}; {self.status}>"


class Identification(Run):
    """Parameters found from records.

    `estimates` is a table of the numbers with their errors; `identification["zeta"]` is the value of one, `errors` a dict
    of their standard errors; `covariance` is a matrix; `measured`, `fitted` and `residuals` are tables.
    """

    kind = "identify"

    @property
    def estimates(self) -> Table:
        """A row for each number: name, unit, value, (standard) error, low and high (ends of the interval of 95 %), freedom
        (degrees of freedom of the error) and note."""
        return self.table("estimates")

    @property
    def values(self) -> Dict[str, float]:
        """The numbers that were found, by name."""
        table = self.estimates
        return dict(zip(table["name"], map(float, table["value"])))

    @property
    def errors(self) -> Dict[str, float]:
        """The standard errors of these numbers, by name; NaN where one is not known."""
        table = self.estimates
        return dict(zip(table["name"], map(float, table["error"])))

    def __getitem__(self, name: str) -> float:
        values = self.values
        if name not in values:
            raise KeyError(f"there is no estimate {name!r}; there are {', '.join(values)}")
        return values[name]

    @property
    def covariance(self) -> numpy.ndarray[Any, Any]:
        """The covariance matrix of the numbers, in the order of `estimates`: NaN for numbers whose error is not known, 0
        where no covariance of two numbers is known."""
        import numpy

        matrix = self._store.read("covariance", self.name)
        unknown = numpy.isnan(self.estimates["error"])
        matrix[unknown, :] = matrix[:, unknown] = numpy.nan
        return matrix

    def _sampled(self, sampling: str) -> Table:
        import numpy

        table = self.samples
        chosen = table.rows(numpy.array([one == sampling for one in table["sampling"]], dtype=bool))
        shown = [name for name, _ in self._record["values"]]
        return Table(shown, [chosen[name] for name in shown], [chosen.units.get(name, "") for name in shown])

    @property
    def measured(self) -> Table:
        """What the records say: the number of the `record`, then the abscissa, such as the time t, and the values."""
        return self._sampled("measured")

    @property
    def fitted(self) -> Table:
        """The same columns as `measured`, by the numbers found."""
        return self._sampled("fitted")

    @property
    def residuals(self) -> Table:
        """The same columns: values measured less values fitted."""
        return self._sampled("residual")

    @property
    def found_model(self) -> Model:
        """A copy of the model with the parameters that were found."""
        model = self.model
        known = model.parameters.independent
        for name, value in self.values.items():
            if name in known:
                model.parameters[name] = value
        return model

    def __repr__(self) -> str:
        table = self.estimates
        shown = [f"{name} = {value:.6g}" + (f" +- {error:.2g}" if error == error and error > 0 else "")
                 + (f" {unit}" if unit else "")
                 for name, value, error, unit in zip(table["name"], table["value"], table["error"], table["unit"])]
        if len(shown) > 8:
            shown[8:] = [f"and {len(shown) - 8} more"]
        return f"<Identification {self.name} of {self._record['model_name']}: {', '.join(shown) or self.status}>"
