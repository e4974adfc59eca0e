# %% [markdown]
# # Assignment 2: BRDFs and their laws
#
# A bidirectional reflectance distribution function (BRDF) says how much of the light from $\omega_i$ leaves
# towards $\omega_o$:
#
# $$f_r(\omega_i, \omega_o) = \frac{\mathrm{d}L_o}{L_i \cos\theta_i \, \mathrm{d}\omega_i}.$$
#
# A physical one is reciprocal, $f_r(\omega_i, \omega_o) = f_r(\omega_o, \omega_i)$, and conserves energy:
# $\int f_r \cos\theta_o \, \mathrm{d}\omega_o \le 1$ for every $\omega_i$. Write the classical models, find
# which of the laws each one obeys, and mend the one that does not. Keep the names of the functions and of
# their parameters. NumPy suffices; a function that takes one pair of directions at a time counts as well.
#
# You see how you fare with **ordinary inputs**. **Hard inputs** (grazing directions, the horizon, exact mirror
# pairs) are hidden, and so are the **laws**, by which BRDFs are judged over the whole hemisphere. A relative
# error of $10^{-9}$ is allowed, and of values [1/sr] below $10^{-9}$ any; what float32 computes earns half.
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

check = rk.grading.practice("brdfs", language="en")

# %% [markdown]
# ## 1. Diffuse reflection (points: 2)
#
# The BRDF of a diffuse surface is the same for all directions. Which constant makes it reflect the share `reflectance` $= \rho$ of the light, whatever its direction?
#
# `wi` points to the light and `wo` to the viewer. Both are unit vectors, arrays of shape `(3,)` or `(N, 3)`; $z$ is the normal. A parameter is one number, or one number for each pair. Return one number for each pair of directions, in $\mathrm{sr}^{-1}$ and without the cosine of the lighting integral. A surface reflects only above the horizon: where $\cos\theta_i \le 0$ or $\cos\theta_o \le 0$, the value is 0.
#
# *Also graded, and not shown before: hard inputs, the laws of a BRDF.*

# %%
def lambert(wi, wo, reflectance):
    """Diffuse reflection."""
    ...

# %%
check(lambert)

# %% [markdown]
# ## 2. The angle from the mirror direction (points: 2)
#
# A mirror reflects light from $r$ towards `wo`, where $r$ is `wo` turned by half a turn about the normal $z$. Return $\max(0, \cos\alpha)$ for the angle $\alpha$ between `wi` and $r$. The horizon plays no part here. `wi` and `wo` are unit vectors of shape `(3,)` or `(N, 3)`.
#
# *Also graded, and not shown before: hard inputs.*

# %%
def mirror_cosine(wi, wo):
    """The angle from the mirror direction."""
    ...

# %%
check(mirror_cosine)

# %% [markdown]
# ## 3. Phong's model of 1975 (points: 3)
#
# Phong drew highlights as $k_s \cos^n\alpha$ for unit flux on a plane that faces the light, without the cosine of incidence. As a BRDF this is $f = k_s \cos^n\alpha / \cos\theta_i$, with $k_s$ = `coefficient` in $\mathrm{sr}^{-1}$, $n$ = `exponent`, and $\cos\alpha$ as in `mirror_cosine`. Write it as it stands. It breaks both laws: find out why, and at which angles.
#
# `wi` points to the light and `wo` to the viewer. Both are unit vectors, arrays of shape `(3,)` or `(N, 3)`; $z$ is the normal. A parameter is one number, or one number for each pair. Return one number for each pair of directions, in $\mathrm{sr}^{-1}$ and without the cosine of the lighting integral. A surface reflects only above the horizon: where $\cos\theta_i \le 0$ or $\cos\theta_o \le 0$, the value is 0.
#
# *Also graded, and not shown before: hard inputs, the laws of a BRDF.*

# %%
def phong_original(wi, wo, exponent, coefficient):
    """Phong's model of 1975."""
    ...

# %%
check(phong_original)

# %% [markdown]
# ## 4. The modified Phong lobe (points: 3)
#
# Drop the division, and the lobe $f = N(n) \cos^n\alpha$ is reciprocal. Find the $N(n)$ for which it reflects exactly all light at normal incidence: there $\alpha = \theta$, and $\int f \cos\theta\, \mathrm{d}\omega = 1$ over the hemisphere. $n$ = `exponent`.
#
# `wi` points to the light and `wo` to the viewer. Both are unit vectors, arrays of shape `(3,)` or `(N, 3)`; $z$ is the normal. A parameter is one number, or one number for each pair. Return one number for each pair of directions, in $\mathrm{sr}^{-1}$ and without the cosine of the lighting integral. A surface reflects only above the horizon: where $\cos\theta_i \le 0$ or $\cos\theta_o \le 0$, the value is 0.
#
# *Also graded, and not shown before: hard inputs, the laws of a BRDF.*

# %%
def phong(wi, wo, exponent):
    """The modified Phong lobe."""
    ...

# %%
check(phong)

# %% [markdown]
# ## 5. The half vector (points: 2)
#
# Return $\cos\delta = h \cdot n$ for the half vector $h = (\omega_i + \omega_o) / |\omega_i + \omega_o|$ and the normal $n = z$, and 0 where either direction is not above the horizon. `wi` and `wo` are unit vectors of shape `(3,)` or `(N, 3)`; they may be opposite.
#
# *Also graded, and not shown before: hard inputs.*

# %%
def half_cosine(wi, wo):
    """The half vector."""
    ...

# %%
check(half_cosine)

# %% [markdown]
# ## 6. Blinn-Phong, normalised (points: 3)
#
# Blinn's lobe is $f = N(n) \cos^n\delta$, with $n$ = `exponent` and $\delta$ the angle between half vector and normal. The constant met in books, $(n + 8)/(8\pi)$, gains 7.5 % of energy at $n = 10$. Find the one for which exactly all light is reflected at normal incidence; there $\delta = \theta/2$. (With $c = \cos\delta$: $\cos\theta = 2c^2 - 1$ and $\mathrm{d}\omega = 8\pi\, c\, |\mathrm{d}c|$, where $c$ goes from $1/\sqrt 2$ to 1.)
#
# `wi` points to the light and `wo` to the viewer. Both are unit vectors, arrays of shape `(3,)` or `(N, 3)`; $z$ is the normal. A parameter is one number, or one number for each pair. Return one number for each pair of directions, in $\mathrm{sr}^{-1}$ and without the cosine of the lighting integral. A surface reflects only above the horizon: where $\cos\theta_i \le 0$ or $\cos\theta_o \le 0$, the value is 0.
#
# *Also graded, and not shown before: hard inputs, the laws of a BRDF.*

# %%
def blinn_phong(wi, wo, exponent):
    """Blinn-Phong, normalised."""
    ...

# %%
check(blinn_phong)

# %% [markdown]
# ## 7. How far from reciprocal? (points: 2)
#
# You check someone else's BRDF: `a` holds its values $f(\omega_i, \omega_o)$ for some pairs of directions, and `b` those with the directions exchanged, at least 0. For each pair return the relative asymmetry $|a - b| / \max(a, b)$, and 0 where both values are 0. Try it on your own models.
#
# *Also graded, and not shown before: hard inputs.*

# %%
def asymmetry(a, b):
    """How far from reciprocal?."""
    ...

# %%
check(asymmetry)

# %% [markdown]
# ## 8. Diffuse and specular together (points: 3)
#
# A surface reflects the share $k_d$ = `diffuse` diffusely, and a share in the modified Phong lobe: $f = k_d/\pi + k_s N(n) \cos^n\alpha$, with $k_s$ = `specular`, $n$ = `exponent` and the $N(n)$ of `phong`. Users may ask for too much: where $k_d + k_s > 1$, divide both by their sum, so that energy is conserved.
#
# `wi` points to the light and `wo` to the viewer. Both are unit vectors, arrays of shape `(3,)` or `(N, 3)`; $z$ is the normal. A parameter is one number, or one number for each pair. Return one number for each pair of directions, in $\mathrm{sr}^{-1}$ and without the cosine of the lighting integral. A surface reflects only above the horizon: where $\cos\theta_i \le 0$ or $\cos\theta_o \le 0$, the value is 0.
#
# *Also graded, and not shown before: hard inputs, the laws of a BRDF.*

# %%
def mixed(wi, wo, diffuse, specular, exponent):
    """Diffuse and specular together."""
    ...

# %%
check(mixed)

# %% [markdown]
# ## All questions at once

# %%
check.all()

# %% [markdown]
# ## How to hand in
#
# Restart the kernel and run all cells once more, so that nothing depends on a cell that is gone; save, and hand
# in this file under its own name. A function that you leave as it is costs its own points only.
