"""What tells how far a computation is."""

from __future__ import annotations


def told_to(progress, unit: str):
    """A function for the compiled part (None: nothing is told), and one that ends the telling.

    progress: True shows tqdm's bar, where tqdm is installed; a function is called with what the unit says.
    """
    if progress is None or progress is False:
        return None, lambda: None
    if callable(progress):
        if unit == "time":
            return (lambda fraction, time: progress(None if fraction < 0 else fraction, time)), lambda: None
        return progress, lambda: None
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None, lambda: None
    if unit == "time":
        bar = tqdm(total=1.0, bar_format="{l_bar}{bar}| {elapsed}<{remaining}")

        def tell(fraction, time):
            bar.set_postfix_str(f"time {time:.6g}", refresh=False)
            bar.n = max(fraction, 0.0)
            bar.refresh()
    else:
        bar = tqdm(unit="point")

        def tell(state):
            bar.total = state["points"] or None
            bar.n = state["done"]
            if state["parameter"] is not None:
                bar.set_postfix_str(f"at {state['parameter']:.6g}", refresh=False)
            bar.refresh()

    return tell, bar.close
