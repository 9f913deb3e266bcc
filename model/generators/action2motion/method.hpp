// Action2Motion as a method of generating motions (Guo et al., ACM Multimedia 2020).
#pragma once

#include "model/generators/method.hpp"

namespace actformer::model::action2motion {

Method method();

}  // namespace actformer::model::action2motion
