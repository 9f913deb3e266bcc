// LeakyReLU of one number. T float or double.
#pragma once

namespace actformer::model::cpu {

/// `number` where `sign` is above 0, else times `leak`. The product is made either way: a compiler must not multiply where the program
/// does not, and would branch on every number.
template <typename T>
inline T leaky(T sign, T number, T leak) {
    const T less = number * leak;
    return sign > 0 ? number : less;
}

}  // namespace actformer::model::cpu
