// The library's errors as Python's sundog.Error.
#include "values.h"

using sundog::Error;

namespace {

constexpr const char* kinds[] = {"usage", "scene", "device", "build", "io", "internal"};

/// Raises Error as Python's sundog.Error, with its facts as attributes.
void raise(const Error& error, void* type) {
  const nb::object raised = nb::borrow(static_cast<PyObject*>(type))(text_of(error.what()));
  nb::setattr(raised, "kind", nb::str(kinds[static_cast<int>(error.kind())]));
  nb::setattr(raised, "file", text_of(error.file()));
  nb::setattr(raised, "place", text_of(error.place()));
  nb::setattr(raised, "reason", text_of(error.reason()));
  nb::setattr(raised, "log", text_of(error.log()));
  nb::setattr(raised, "status", nb::int_(error.status()));
  PyErr_SetObject(static_cast<PyObject*>(type), raised.ptr());
}

}  // namespace

nb::object text_of(const std::string& text) {
  return nb::steal(PyUnicode_DecodeUTF8(text.data(), Py_ssize_t(text.size()), "surrogateescape"));
}

void add_error(nb::module_& m) {
  PyObject* type = PyErr_NewExceptionWithDoc(
      "sundog.Error",
      "What the library refuses or cannot do. kind: \"usage\", \"scene\", \"device\", \"build\", \"io\" or "
      "\"internal\"; file, place, reason, log, status: the facts, empty or 0 where there are none.",
      PyExc_RuntimeError, nullptr);
  m.attr("Error") = nb::borrow(type);
  nb::register_exception_translator(
      [](const std::exception_ptr& thrown, void* payload) {
        try {
          std::rethrow_exception(thrown);
        } catch (const Error& error) {
          raise(error, payload);
        }
      },
      type);
}
