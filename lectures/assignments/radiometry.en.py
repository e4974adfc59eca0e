# %% [markdown]
# # Assignment 1: radiometry
#
# Radiometry.
#
# Write the body of each function in place of `...`. Keep the names of the functions and of their parameters.
#
# - Unless a question says otherwise: parameters are NumPy arrays of float64 of one length, or numbers, and the
#   function returns an array of that length; angles are in radians, all else in SI units.
# - Functions are graded alone: what one of them needs must be defined or imported in this file. NumPy is there,
#   radiokit is not.
# - Your functions are graded on other numbers than those they are checked on here.
# - `check(function)` judges a function at once, and names the mistake where it knows it.

# %%
import numpy as np

import radiokit as rk

check = rk.grading.practice("radiometry", language="en")

# %% [markdown]
# ## 1. Irradiance from a point light (points: 2)
#
# ...

# %%
def irradiance(intensity, distance, theta):
    """Irradiance from a point light."""
    ...

# %%
check(irradiance)

# %% [markdown]
# ## All questions at once

# %%
check.all()

# %% [markdown]
# ## How to hand in
#
# Restart the kernel and run all cells once more, so that nothing depends on a cell that is gone; save, and hand
# in this file under its own name. A function that you leave as it is costs its own points only.
