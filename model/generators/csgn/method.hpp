// CSGN as a method of generating motions (Yan et al., ICCV 2019), conditional as the ActFormer paper has it.
#pragma once

#include "model/generators/method.hpp"

namespace actformer::model {

Method csgn_method();

}  // namespace actformer::model
