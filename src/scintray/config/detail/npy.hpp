#pragma once
/// Arrays of NumPy's files.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scintray/config/columns.hpp"

namespace scintray::config {

/// Numbers at equal steps within the bytes of an array.
struct NumpyField {
  std::string name;       ///< empty: the array has no fields
  char kind = 'f';        ///< f, i, u or b
  std::size_t bytes = 8;  ///< of a number
  bool big_endian = false;
  std::size_t offset = 0;  ///< of the first within a row
};

/// An array of a .npy file, of versions 1 to 3 (NumPy Enhancement Proposal 1 and numpy.lib.format).
struct NumpyArray {
  std::vector<NumpyField> fields;  ///< one without a name for plain numbers
  std::size_t item_bytes = 0;      ///< of an element: of all its fields
  std::vector<std::size_t> shape;
  bool fortran_order = false;
  std::size_t data = 0;  ///< position of the first byte
};

/// Header of an array. Throws InputError at `where` for other content, for objects, strings and nested
/// fields, and when there are fewer bytes than the shape requires.
NumpyArray read_numpy_header(std::string_view bytes, const core::FileLocation& where);

/// Arrays of a .npy or .npz file, in memory.
class NumpyFile {
 public:
  explicit NumpyFile(const ColumnFile& file);

  /// A column as numbers: a field, a numbered column, or an array of a .npz file. Throws InputError for
  /// another name, and for an array of a .npz file that is not one-dimensional.
  std::vector<double> column(const std::string& name) const;

 private:
  const ColumnFile& file_;
  std::map<std::string, std::string> contents_;  ///< by the name of the array; of a .npy file under ""
  std::map<std::string, NumpyArray> arrays_;
};

}  // namespace scintray::config
