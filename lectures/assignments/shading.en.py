# %% [markdown]
# # Assignment 3: shading and Monte Carlo
#
# What a point of a surface sends to the viewer: first a sum over point lights, then an integral over large ones, by quadrature and by Monte Carlo. Every estimate comes with its standard error, and the error is judged as well as the value. Write each function under the name that is given; NumPy is there. Loops are allowed, and arrays are faster.
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

check = rk.grading.practice("shading", language="en")

# %% [markdown]
# ## 1. A sum over point lights (points: 3)
#
# A surface lies at the origin, its normal is $z$. Light $j$ is a point at $\mathbf p_j$ (`positions`, shape $(N, K, 3)$, in metres) of the intensity $I_j$ (`intensities`, $(N, K)$, in W/sr). The BRDF's value for the direction to it is $f_j$ (`f`, $(N, K)$, in 1/sr; $\rho/\pi$ for a diffuse surface). Return the reflected radiance, shape $(N,)$:
#
# $$L_o = \sum_{j=1}^{K} f_j \, \frac{I_j \max(0, \cos\theta_j)}{d_j^2}.$$
#
# This is the lecture's sum for the discrete case; what stands there as $L_j$ is the irradiance $I_j/d_j^2$ on a plane normal to the ray. Lights below the horizon give nothing. A function for one point ($N$ left out) is accepted too.

# %%
def direct_light(f, positions, intensities):
    """A sum over point lights."""
    ...

# %%
check(direct_light)

# %% [markdown]
# ## 2. The irradiance from a sphere (points: 3)
#
# A glowing sphere of radiance 1 W/(m² sr) is seen from a point as a disk of the angular radius `half_angle`; its centre stands at the angle `theta` from the normal (both in radians, arrays of shape $(N,)$). Compute the irradiance by quadrature,
#
# $$E = \int_{\Omega} L \max(0, \cos\theta)\, d\omega,$$
#
# to a relative error of $10^{-3}$. The horizon may cut the sphere; what lies below it gives no light.

# %%
def sphere_irradiance(theta, half_angle):
    """The irradiance from a sphere."""
    ...

# %%
check(sphere_irradiance)

# %% [markdown]
# ## 3. A furnace by Monte Carlo (points: 3)
#
# Around a diffuse surface, $f = \rho/\pi$ with $\rho$ = `albedo`, the radiance is 1 from everywhere, so that it reflects exactly $L_o = \int f \cos\theta\, d\omega = \rho$. Estimate this with `samples` directions, uniform over the hemisphere, and return two numbers, `value, standard_error`. The standard error is that of the mean: $s/\sqrt N$, where $s$ is the deviation of the samples' weights $f\cos\theta/p$. Draw from `numpy.random.default_rng(seed)`: the same seed gives the same answer.
#
# The function is run with many seeds: their mean must be $\rho$, their spread must be what the standard error says, and four times as many samples must halve it.

# %%
def furnace(albedo, samples, seed):
    """A furnace by Monte Carlo."""
    ...

# %%
check(furnace)

# %% [markdown]
# ## 4. Cosine-weighted directions (points: 2)
#
# Write two functions: `cosine_sample(u)` returns unit vectors, shape $(N, 3)$, of the density $p(\omega) = \cos\theta/\pi$ about the normal $z$; `cosine_pdf(directions)` returns this density, shape $(N,)$, and 0 below the horizon. `u` is an array of shape $(N, 2)$ of random numbers in $[0, 1)$: draw none yourself. Rows go their own way: direction $i$ follows from `u[i]` alone.

# %%
def cosine_sample(u):
    """Cosine-weighted directions."""
    ...


def cosine_pdf(directions):
    ...

# %%
check(cosine_sample)

# %% [markdown]
# ## 5. Phong's lobe (points: 2.5)
#
# Write `lobe_sample(u, exponent)`, which returns unit vectors, shape $(N, 3)$, whose density is proportional to $\cos^n\theta$ about $z$, with $n$ = `exponent`, above the horizon; and `lobe_pdf(directions, exponent)`, which returns this density per solid angle, shape $(N,)$, normalised so that its integral over the hemisphere is 1, and 0 below the horizon. `u` is an array of shape $(N, 2)$ of random numbers in $[0, 1)$: draw none yourself. Rows go their own way: direction $i$ follows from `u[i]` alone.

# %%
def lobe_sample(u, exponent):
    """Phong's lobe."""
    ...


def lobe_pdf(directions, exponent):
    ...

# %%
check(lobe_sample)

# %% [markdown]
# ## 6. A glossy surface (points: 3)
#
# A glossy surface of the BRDF $f = \frac{n+2}{2\pi}\cos^n\alpha$ is seen along its normal, so that the mirror direction is $z$ and $\alpha = \theta$; $n$ = `exponent`. The light that falls on it from the direction $(x, y, z)$ has the radiance $L = $ `zenith` $\cdot z\ +$ `side` $\cdot (1 + x)$. Estimate
#
# $$L_o = \int f L \cos\theta\, d\omega$$
#
# with `samples` directions, drawn from `seed` as in the furnace, and return `value, standard_error`. Sample the lobe, not the hemisphere: the variance must be at most a tenth of what uniform directions give.

# %%
def glossy(exponent, zenith, side, samples, seed):
    """A glossy surface."""
    ...

# %%
check(glossy)

# %% [markdown]
# ## 7. A window, sampled by area (points: 2.5)
#
# You stand at the origin of a floor, its normal is $z$. A window of radiance 1 W/(m² sr) fills the rectangle $x =$ `distance`, $|y| \le$ `width`$/2$, $0 \le z \le$ `height` and shines towards you. Estimate the irradiance of the floor, with `samples` points uniform over the window's area, by
#
# $$E = \int L \cos\theta\, d\omega = \int_A L\, \frac{\cos\theta \cos\theta'}{d^2}\, dA,$$
#
# where $\theta'$ is the angle at the window, and return `value, standard_error`, with numbers from `seed`. Per solid angle these points have the density $p_\omega = p_A\, d^2/\cos\theta'$ with $p_A = 1/A$.

# %%
def window(distance, width, height, samples, seed):
    """A window, sampled by area."""
    ...

# %%
check(window)

# %% [markdown]
# ## 8. The balance heuristic (points: 1)
#
# A direction was found by sampling a light uniformly over its `area` $A$: the point is at the `distance` $d$, the cosine at the light is `cosine_light` $= \cos\theta'$. Sampling the BRDF would have given it with the density `pdf` per solid angle. One sample is taken of each. Return the weight of the balance heuristic for the light's sample,
#
# $$w = \frac{p_\text{light}}{p_\text{light} + p_\text{BRDF}},$$
#
# with both densities per solid angle. All inputs are arrays of shape $(N,)$; $\cos\theta' = 0$ and $p_\text{BRDF} = 0$ occur, and the weight is then 1.

# %%
def mis_weight(distance, cosine_light, area, pdf):
    """The balance heuristic."""
    ...

# %%
check(mis_weight)

# %% [markdown]
# ## All questions at once

# %%
check.all()

# %% [markdown]
# ## How to hand in
#
# Restart the kernel and run all cells once more, so that nothing depends on a cell that is gone; save, and hand
# in this file under its own name. A function that you leave as it is costs its own points only.
