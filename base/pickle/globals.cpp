// The closed table of names.
#include <array>

#include "base/pickle/node.hpp"

namespace actformer {
namespace {

using Makes = PickleGlobal::Makes;

constexpr std::array table{
    PickleGlobal{"numpy.core.multiarray", "_reconstruct", Makes::array},
    PickleGlobal{"numpy._core.multiarray", "_reconstruct", Makes::array},
    PickleGlobal{"numpy", "ndarray", Makes::array_class},
    PickleGlobal{"numpy", "dtype", Makes::type},
    PickleGlobal{"numpy.core.multiarray", "scalar", Makes::scalar},
    PickleGlobal{"numpy._core.multiarray", "scalar", Makes::scalar},
    PickleGlobal{"numpy.core.numeric", "_frombuffer", Makes::from_buffer},
    PickleGlobal{"numpy._core.numeric", "_frombuffer", Makes::from_buffer},
    PickleGlobal{"_codecs", "encode", Makes::bytes},
    PickleGlobal{"builtins", "bytes", Makes::bytes},
    PickleGlobal{"__builtin__", "bytes", Makes::bytes},
    PickleGlobal{"builtins", "bytearray", Makes::bytes},
    PickleGlobal{"__builtin__", "bytearray", Makes::bytes},
    PickleGlobal{"builtins", "list", Makes::list},
    PickleGlobal{"__builtin__", "list", Makes::list},
    PickleGlobal{"builtins", "tuple", Makes::tuple},
    PickleGlobal{"__builtin__", "tuple", Makes::tuple},
    PickleGlobal{"builtins", "set", Makes::set},
    PickleGlobal{"__builtin__", "set", Makes::set},
    PickleGlobal{"builtins", "frozenset", Makes::set},
    PickleGlobal{"__builtin__", "frozenset", Makes::set},
    PickleGlobal{"builtins", "dict", Makes::dict},
    PickleGlobal{"__builtin__", "dict", Makes::dict},
    PickleGlobal{"collections", "OrderedDict", Makes::dict},
    PickleGlobal{"copyreg", "_reconstructor", Makes::instance},
    PickleGlobal{"copy_reg", "_reconstructor", Makes::instance},
    PickleGlobal{"builtins", "object", Makes::object},
    PickleGlobal{"__builtin__", "object", Makes::object},
    PickleGlobal{"scipy.sparse.csc", "csc_matrix", Makes::object},
    PickleGlobal{"scipy.sparse._csc", "csc_matrix", Makes::object},
    PickleGlobal{"chumpy.ch", "Ch", Makes::object},
    PickleGlobal{"chumpy.reordering", "Select", Makes::object},
    PickleGlobal{"joblib.numpy_pickle", "NumpyArrayWrapper", Makes::joblib_array},
    PickleGlobal{"joblib.numpy_pickle", "NDArrayWrapper", Makes::in_other_file},
    PickleGlobal{"joblib.numpy_pickle", "ZNDArrayWrapper", Makes::in_other_file},
    PickleGlobal{"joblib.numpy_pickle_compat", "NDArrayWrapper", Makes::in_other_file},
    PickleGlobal{"joblib.numpy_pickle_compat", "ZNDArrayWrapper", Makes::in_other_file},
    PickleGlobal{"torch._utils", "_rebuild_tensor", Makes::tensor},
    PickleGlobal{"torch._utils", "_rebuild_tensor_v2", Makes::tensor},
    PickleGlobal{"torch._utils", "_rebuild_parameter", Makes::tensor},
    PickleGlobal{"torch", "Size", Makes::size},
    PickleGlobal{"torch", "FloatStorage", Makes::storage},
    PickleGlobal{"torch", "DoubleStorage", Makes::storage},
    PickleGlobal{"torch", "HalfStorage", Makes::storage},
    PickleGlobal{"torch", "LongStorage", Makes::storage},
};

}  // namespace

const PickleGlobal* pickle_global(std::string_view module, std::string_view name) {
    for (const auto& global : table)
        if (global.module == module && global.name == name) return &global;
    return nullptr;
}

}  // namespace actformer
