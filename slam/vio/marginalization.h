// Removing states from the window without forgetting what they told about the others: the Schur complement of
// their normal equations (Leutenegger et al., IJRR 2015; Qin et al., T-RO 2018).
#pragma once

#include <vector>

#include "slam/vio/window_equations.h"

namespace vsslam {

/// Prior on the frames that stay when frame number `leaving` goes. Eigenvalues below 1e-8 count as unknown.
LinearPrior marginalize(const std::vector<WindowFactor>& factors, const Linearization& at, int leaving);

}  // namespace vsslam
