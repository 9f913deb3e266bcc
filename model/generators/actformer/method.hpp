// ActFormer as a method of generating motions (Xu, Song et al., ICCV 2023).
#pragma once

#include "model/generators/method.hpp"

namespace actformer::model {

Method actformer_method();

}  // namespace actformer::model
