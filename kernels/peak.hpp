// A device's peak arithmetic rate, measured.
#pragma once

#include <cstdint>

#include "kernels/device.hpp"

namespace actformer::kernels {

/// Floating-point operations a second of a kernel that does nothing but fused multiply-adds on vectors of `vec` floats in
/// registers (each counts two): the best of `repeats` runs of some milliseconds.
double measure_peak(Device& device, std::uint32_t vec, int repeats);

}  // namespace actformer::kernels
