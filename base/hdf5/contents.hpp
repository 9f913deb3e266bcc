// A checksum of what an HDF5 file says, whatever its bytes: the library moves those, and drops padding, when another program opens
// the file for writing and closes it unchanged.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "base/hdf5/handle.hpp"

namespace actformer::hdf5 {

/// Gathers names, types, shapes and checksums of values, in any order. Any changed number, text, name or attribute changes the
/// checksum; a group counts by its name.
class Contents {
  public:
    void add_group(const std::string& path);
    void add_array(const std::string& path, hid_t type, const Shape& shape,
                   const std::string& values_checksum);

    /// An attribute of the group or array at `path`; that of the root is "".
    void add_attribute(const std::string& path, const std::string& name, hid_t type, const Shape& shape,
                       std::string_view values);

    /// `without`: an array whose values do not count, only its type and shape.
    std::string checksum(const std::string& without = {}) const;

  private:
    struct Said {
        std::string what;    ///< type and shape
        std::string values;  ///< their checksum
    };
    std::map<std::string, Said> said_;
};

/// "float32", "uint64", "text12" ("be" behind where the high byte comes first). Empty for any other type, also for numbers of an unusual
/// layout: in those the same bytes are other numbers.
std::string name_of_type(hid_t type);

}  // namespace actformer::hdf5
