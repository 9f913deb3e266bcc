// What Adam is told.
#pragma once

namespace actformer::model {

struct AdamSettings {
    double rate = 2e-4, beta1 = 0, beta2 = 0.999, epsilon = 1e-8;
    double weight_decay =
        0;  ///< of AdamW (Loshchilov and Hutter 2019): a step takes rate * weight_decay of every weight
};

}  // namespace actformer::model
