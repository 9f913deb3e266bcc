// ACTOR as a method of generating motions (Petrovich et al., ICCV 2021).
#pragma once

#include "model/generators/method.hpp"

namespace actformer::model {

Method actor_method();

}  // namespace actformer::model
