#pragma once

#include <functional>
#include <string>

#include "base/error.hpp"

namespace actformer::test {

/// What the Error says that `what` throws; empty where it throws none.
inline std::string error_of(const std::function<void()>& what) {
    try {
        what();
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

}  // namespace actformer::test
