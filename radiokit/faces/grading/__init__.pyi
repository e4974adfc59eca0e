from .handout.kernel import kernel_check as kernel_check
from .handout.kernel import kernel_points as kernel_points
from .handout.write import write_handout as write_handout
