// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <stdexcept>

#include "bindings.hpp"
#include "gridmerge/io/file_error.hpp"

namespace gridmerge::python {

nb::str to_str(const std::string& text) {
  return nb::steal<nb::str>(
      PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "surrogateescape"));
}

std::vector<nb::str> to_strs(const std::vector<std::string>& texts) {
  std::vector<nb::str> strs;
  strs.reserve(texts.size());
  for (const std::string& text : texts) strs.push_back(to_str(text));
  return strs;
}

namespace {

void raise(PyObject* type, const char* message) {
  PyErr_SetObject(type, to_str(message).ptr());
}

// nanobind's own translation fails for a message that is not UTF-8, and names of files are any bytes.
void translate(const std::exception_ptr& exception, void* file_error) {
  try {
    std::rethrow_exception(exception);
  } catch (const FileError& error) {
    raise(static_cast<PyObject*>(file_error), error.what());
  } catch (const std::invalid_argument& error) {
    raise(PyExc_ValueError, error.what());
  } catch (const std::out_of_range& error) {
    raise(PyExc_IndexError, error.what());
  } catch (const std::runtime_error& error) {
    raise(PyExc_RuntimeError, error.what());
  }
}

}  // namespace

void bind_errors(nb::module_& module) {
  const auto file_error = nb::exception<FileError>(module, "FileError", PyExc_OSError);
  nb::register_exception_translator(translate, file_error.ptr());
}

}  // namespace gridmerge::python
