// Errors that the machine causes, not the inputs: a full or broken disk, too few resources. The
// same command may end well later, or on another machine.
#pragma once

#include <string_view>

namespace fovea {

/// Base of these errors, next to InputError or OutputError.
class MachineError {
 public:
  MachineError() = default;
  MachineError(const MachineError&) = default;
  MachineError& operator=(const MachineError&) = default;
  virtual ~MachineError() = default;
};

/// An InputError or OutputError of the machine.
template <class Base>
class OfMachine : public Base, public MachineError {
 public:
  using Base::Base;
};

/// Whether the machine causes an error of the operating system.
/// @param error  errno
bool is_machine_error(int error);

/// Throws the error `Base`, or OfMachine<Base>.
template <class Base>
[[noreturn]] void throw_error(bool of_machine, std::string_view what, std::string_view where,
                              std::string_view remedy) {
  if (of_machine) throw OfMachine<Base>(what, where, remedy);
  throw Base(what, where, remedy);
}

}  // namespace fovea
