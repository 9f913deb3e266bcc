// What errors of libtorch and its libraries say, without the places in its sources. Includes torch headers.
#pragma once

#include <c10/util/Exception.h>

#include <exception>
#include <string>

namespace actformer::model {

inline std::string one_line(const std::exception& error) {
    const auto* c10 = dynamic_cast<const c10::Error*>(&error);
    const std::string text = c10 ? c10->what_without_backtrace() : error.what();
    return text.substr(0, text.find('\n'));
}

}  // namespace actformer::model
