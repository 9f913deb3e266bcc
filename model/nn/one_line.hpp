// What libtorch's errors say, without the places in its sources. Includes torch headers.
#pragma once

#include <c10/util/Exception.h>

#include <string>

namespace actformer::model {

inline std::string one_line(const c10::Error& error) {
    const std::string text = error.what_without_backtrace();
    return text.substr(0, text.find('\n'));
}

}  // namespace actformer::model
