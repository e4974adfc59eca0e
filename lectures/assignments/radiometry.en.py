# %% [markdown]
# # Assignment 1: radiometry
#
# Write ten functions with the names and arguments given. Each takes **numbers or NumPy arrays of equal
# length** and returns as many numbers; vectors are arrays `(N, 3)`. A function that takes one input at a time
# counts as well. The module `math` and NumPy suffice.
#
# All is in SI units: metres, watts, steradians. Angles are in **radians**, unless a name ends in `_deg`.
# Arguments are not to be changed.
#
# Each question has two parts. **Ordinary inputs** (1.5 points) allow a relative error of $10^{-5}$. **Hard
# inputs** (0.5 points) are hidden, and ask for $10^{-9}$ where the question says nothing else: there float64
# is needed, and a formula that loses no digits.
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
# ## 1. Solid angle of a cone (points: 2)
#
# Return the solid angle of a circular cone [sr],
# $$\Omega = \int_0^{2\pi}\!\!\int_0^{\alpha} \sin\theta \, d\theta \, d\varphi .$$
#
# - `half_angle`: $\alpha$ [rad], from the axis to the edge, $0 < \alpha \le \pi$; a number or an array.
#
# The whole sphere, $\alpha = \pi$, gives $4\pi$ sr. **Hard inputs:** $\alpha$ from $10^{-9}$ to $10^{-3}$,
# where all digits of $1 - \cos\alpha$ may be lost; a relative error of $10^{-9}$ is asked for there too.
#
# *Also graded, and not shown before: hard inputs.*

# %%
def cone_solid_angle(half_angle):
    """Solid angle of a cone."""
    ...

# %%
check(cone_solid_angle)

# %% [markdown]
# ## 2. Solid angle of a triangle (points: 2)
#
# Return the solid angle [sr] of a triangle that is seen from the origin, by the formula of Van Oosterom and
# Strackee (1983),
# $$\tan\frac{\Omega}{2} = \frac{|\mathbf a \cdot (\mathbf b \times \mathbf c)|}
# {abc + (\mathbf a \cdot \mathbf b)\,c + (\mathbf b \cdot \mathbf c)\,a + (\mathbf c \cdot \mathbf a)\,b} ,$$
# where $a = |\mathbf a|$ and so on.
#
# - `a`, `b`, `c`: the corners [m], arrays `(N, 3)`, in either winding; the answer has shape `(N,)`.
#
# The answer is never negative: from 0 to $2\pi$. **Hard inputs:** small and distant triangles (down to
# $10^{-7}$ of their distance), where the triple product of the corners loses all digits and that of the
# differences $\mathbf b - \mathbf a$, $\mathbf c - \mathbf a$ does not; and triangles all around the eye,
# whose $\Omega$ is above $\pi$: mind the quadrant. The relative error is to be $10^{-9}$.
#
# *Also graded, and not shown before: hard inputs.*

# %%
def triangle_solid_angle(a, b, c):
    """Solid angle of a triangle."""
    ...

# %%
check(triangle_solid_angle)

# %% [markdown]
# ## 3. Flux of a spotlight (points: 2)
#
# A spotlight has the intensity $I(\theta) = I_0 \cos^n\theta$. Return the flux [W] that it sends into the
# cone of half angle $\alpha$ around its axis,
# $$\Phi = \int I \, d\omega = 2\pi \int_0^{\alpha} I(\theta) \sin\theta \, d\theta .$$
#
# - `intensity`: $I_0$ [W/sr], on the axis;
# - `exponent`: $n \ge 0$, not always an integer; $n = 0$ is the same intensity in all directions of the cone;
# - `half_angle`: $\alpha$ [rad], $0 < \alpha < \pi/2$.
#
# Numbers or arrays of equal length. **Hard inputs:** $\alpha$ from $10^{-8}$ to $10^{-3}$, with $n$ from 0 to
# $10^{17}$, where $1 - \cos^{n+1}\alpha$ loses its digits (think of `expm1` and `log1p`); the relative error
# is to be $10^{-9}$.
#
# *Also graded, and not shown before: hard inputs.*

# %%
def spot_flux(intensity, exponent, half_angle):
    """Flux of a spotlight."""
    ...

# %%
check(spot_flux)

# %% [markdown]
# ## 4. Inverse square law (points: 2)
#
# A point source radiates the flux $\Phi$ evenly in all directions. Return the irradiance [W/m²] of a surface
# that faces it at the distance $d$.
#
# - `flux`: $\Phi$ [W];
# - `distance`: $d > 0$ [m].
#
# Numbers or arrays of equal length. **Hard inputs:** $d$ from $10^{-170}$ to $10^{170}$, where $d^2$ is too
# small or too large for float64 and the irradiance is not; a relative error of $10^{-9}$ is asked for there
# too.
#
# *Also graded, and not shown before: hard inputs.*

# %%
def isotropic_irradiance(flux, distance):
    """Inverse square law."""
    ...

# %%
check(isotropic_irradiance)

# %% [markdown]
# ## 5. Cosine law (points: 2)
#
# Return the irradiance [W/m²] that a point source gives a surface,
# $$E = \frac{I \cos\theta}{d^2}, \qquad E = 0 \text{ if the light is behind the surface.}$$
#
# - `intensity`: $I$ [W/sr], towards the surface;
# - `distance`: $d > 0$ [m];
# - `theta_deg`: the angle $\theta$ between the normal and the direction to the light, **in degrees**,
#   $0 \le \theta \le 180$.
#
# Numbers or arrays of equal length. **Hard inputs:** $\theta$ within $10^{-3}$ to $10^{-10}$ degrees of 90°,
# where the rounding of $\pi/2$ spoils the cosine; at 90° and beyond it, exactly 0 is right. The relative
# error is to be $10^{-9}$.
#
# *Also graded, and not shown before: hard inputs.*

# %%
def lamp_irradiance(intensity, distance, theta_deg):
    """Cosine law."""
    ...

# %%
check(lamp_irradiance)

# %% [markdown]
# ## 6. Irradiance from a point light, in vectors (points: 2)
#
# Return the irradiance [W/m²] at a point of a surface, from a point light that shines alike in all directions:
# the cosine law and the inverse square law, with $\cos\theta$ from the dot product of the unit normal and the
# unit vector **from the surface to the light**; 0 if the light is behind the surface.
#
# - `position`: of the point [m], array `(N, 3)`;
# - `normal`: of the surface, `(N, 3)`, of **any length** above 0;
# - `light`: the position of the light [m], `(N, 3)`;
# - `intensity`: $I$ [W/sr], `(N,)`.
#
# The answer has shape `(N,)`. **Hard inputs:** coordinates from $10^{-170}$ to $10^{170}$ m, normals from
# $10^{-200}$ to $10^{200}$ long, whose squares are out of range: scale vectors by their largest component
# first. The relative error is to be $10^{-9}$.
#
# *Also graded, and not shown before: hard inputs.*

# %%
def light_irradiance(position, normal, light, intensity):
    """Irradiance from a point light, in vectors."""
    ...

# %%
check(light_irradiance)

# %% [markdown]
# ## 7. Irradiance from a radiance (points: 2)
#
# Light of the radiance $L$ falls on a surface evenly from a circular cone around its normal. Return the
# irradiance [W/m²],
# $$E = \int L \cos\theta \, d\omega = 2\pi \int_0^{\alpha} L \cos\theta \sin\theta \, d\theta .$$
#
# - `radiance`: $L$ [W/(m² sr)];
# - `half_angle`: $\alpha$ [rad], from the normal to the edge of the cone, $0 < \alpha \le \pi/2$.
#
# Numbers or arrays of equal length. The whole hemisphere, $\alpha = \pi/2$, gives $\pi L$, as a Lambertian
# surface has the exitance $M = \pi L$. **Hard inputs:** $\alpha$ from $10^{-9}$ to $10^{-3}$, where
# $1 - \cos^2\alpha$ loses its digits; the relative error is to be $10^{-9}$.
#
# *Also graded, and not shown before: hard inputs.*

# %%
def cone_irradiance(radiance, half_angle):
    """Irradiance from a radiance."""
    ...

# %%
check(cone_irradiance)

# %% [markdown]
# ## 8. Irradiance from a small patch (points: 2)
#
# A small flat patch shines with the radiance $L$ from its front. Return the irradiance [W/m²] that it gives a
# surface at the distance $d$, $E = L \cos\theta\, \Delta\omega$ with the solid angle of the patch
# $$\Delta\omega = \frac{A \cos\theta'}{d^2} .$$
#
# - `radiance`: $L$ [W/(m² sr)];
# - `area`: $A$ [m²], small against $d^2$;
# - `distance`: $d$ [m];
# - `theta`: $\theta$ [rad], at the surface, from its normal to the patch, $0 \le \theta \le \pi$;
# - `theta_light`: $\theta'$ [rad], at the patch, from its normal to the surface, $0 \le \theta' \le \pi$.
#
# Numbers or arrays of equal length. The answer is 0 if the patch is behind the surface **or** the surface
# behind the patch. **Hard inputs:** both at once.
#
# *Also graded, and not shown before: hard inputs.*

# %%
def patch_irradiance(radiance, area, distance, theta, theta_light):
    """Irradiance from a small patch."""
    ...

# %%
check(patch_irradiance)

# %% [markdown]
# ## 9. Photometry: the luminance of a spectrum (points: 2)
#
# A Lambertian surface radiates the spectral exitance $M_\lambda$. Return its luminance [cd/m²]: first the
# luminous exitance [lm/m²],
# $$M_v = K_m \int V(\lambda)\, M_\lambda \, d\lambda, \qquad K_m = 683\ \text{lm/W},$$
# by the **trapezoidal rule** over the samples given, then $L_v$ from it, as for any Lambertian surface.
#
# - `wavelength`: $\lambda$ [nm], array `(N, K)`: each row has a grid of its own;
# - `exitance`: $M_\lambda$ [W/(m² nm)] there, `(N, K)`;
# - `efficiency`: $V(\lambda)$ there, `(N, K)`.
#
# The answer has shape `(N,)`; a function of one row, `(K,)` arrays, counts as well. **Hard inputs:** the
# steps are uneven, and in some rows the wavelengths fall; the answer is never negative.
#
# *Also graded, and not shown before: hard inputs.*

# %%
def luminance(wavelength, exitance, efficiency):
    """Photometry: the luminance of a spectrum."""
    ...

# %%
check(luminance)

# %% [markdown]
# ## 10. Reflected radiance as a sum (points: 2)
#
# $K$ small lights shine on a Lambertian surface, whose BRDF is $f = \rho/\pi$. Return the radiance of the
# reflected light [W/(m² sr)], the lecture's discrete sum with the solid angles written out,
# $$L_o = \sum_{j=1}^{K} f \, L_j \cos\theta_j \, \Delta\omega_j ,$$
# where lights below the horizon, $\cos\theta_j < 0$, give nothing.
#
# - `albedo`: $\rho$, from 0 to 1, array `(N,)`;
# - `radiance`: $L_j$ [W/(m² sr)], array `(N, K)`;
# - `cosine`: $\cos\theta_j$, `(N, K)`;
# - `solid_angle`: $\Delta\omega_j$ [sr], `(N, K)`.
#
# The answer has shape `(N,)`; a function of one row, a number and `(K,)` arrays, counts as well. **Hard
# inputs:** 4096 lights, one of which is a sun and the others are stars, each lost when it is added to the sun
# alone: use `numpy.sum` along the last axis or `math.fsum`; the relative error is to be $3\cdot10^{-14}$.
#
# *Also graded, and not shown before: hard inputs.*

# %%
def reflected_radiance(albedo, radiance, cosine, solid_angle):
    """Reflected radiance as a sum."""
    ...

# %%
check(reflected_radiance)

# %% [markdown]
# ## All questions at once

# %%
check.all()

# %% [markdown]
# ## How to hand in
#
# Restart the kernel and run all cells once more, so that nothing depends on a cell that is gone; save, and hand
# in this file under its own name. A function that you leave as it is costs its own points only.
