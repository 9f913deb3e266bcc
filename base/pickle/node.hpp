// Values that hold others, and where they and the texts that are not in the file lie.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "base/pickle/value.hpp"

namespace actformer {

/// A name that pickles may call: the reader's own code makes what its counterpart in Python would have made.
struct PickleGlobal {
    /// What calling it makes, or what an instance of it is.
    enum class Makes {
        array,        ///< numpy's _reconstruct: an array whose state follows
        array_class,  ///< ndarray itself
        type,         ///< numpy's dtype
        scalar,       ///< one number of a type
        from_buffer,  ///< an array over bytes
        bytes,        ///< also of the text in which old protocols write them
        list,
        tuple,
        set,
        dict,
        instance,       ///< copyreg's _reconstructor: an instance of a class
        object,         ///< a class whose instances are their attributes
        joblib_array,   ///< an array whose numbers follow in the file
        in_other_file,  ///< an array in a file beside this one
        storage,        ///< PyTorch: a class of numbers that lie elsewhere in the file
        tensor,         ///< PyTorch: a call that is kept as it stands, for readers of tensors
        size,           ///< PyTorch: a tuple
    };
    std::string_view module, name;
    Makes makes;
};

/// Null for a name that is none of the table's.
const PickleGlobal* pickle_global(std::string_view module, std::string_view name);

struct PickleNode {
    enum class Kind : std::uint8_t {
        tuple,
        list,
        set,
        dict,
        object,
        array,
        unfilled,
        type,
        call,
        reference
    };  ///< unfilled: an array without its state; call: of `of`, with its arguments; reference: by its one item
    Kind kind = Kind::tuple;
    std::uint32_t depth = 1;  ///< of values in values, this one counted
    std::vector<PickleValue>
        items;  ///< of a dict: key, value, key, value; of an object: its attributes, a dict
    const PickleGlobal* of = nullptr;   ///< an object's class
    std::unique_ptr<NumpyArray> array;  ///< of arrays and types
};

struct PickleStore {
    std::deque<PickleNode> nodes;
    std::deque<std::string> texts;
    std::string unpacked;  ///< a compressed file's text
};

}  // namespace actformer
