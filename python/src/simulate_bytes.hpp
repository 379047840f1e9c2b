// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "gridmerge/simulate/simulate.hpp"

namespace gridmerge::python {

/// A simulation in a form that another process reads, on any machine: every bit of it.
std::string to_bytes(const Simulation& simulation);

/// What to_bytes() was given. Throws std::invalid_argument for bytes that are no simulation.
Simulation simulation_from_bytes(std::string_view bytes);

}  // namespace gridmerge::python
