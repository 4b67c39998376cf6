#include "scintray/core/detail/h5_internal.hpp"

namespace scintray::core::h5 {

void Group::set_attribute(const std::string& member, const std::string& name, const std::string& value) {
  const Quiet quiet;
  state_->write_text_attribute(member, name, value.c_str());
}

void Group::set_attribute(const std::string& member, const std::string& name, double value) {
  const Quiet quiet;
  state_->write_attribute(member, name, H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, &value);
}

void Group::set_attribute(const std::string& member, const std::string& name, std::int64_t value) {
  const Quiet quiet;
  state_->write_attribute(member, name, H5T_NATIVE_INT64, H5T_NATIVE_INT64, &value);
}

std::vector<std::string> Group::attributes(const std::string& member) const {
  const Quiet quiet;
  const Handle owner = state_->attribute_owner(member);
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5A_info_t*, void* data) -> herr_t {
    static_cast<std::vector<std::string>*>(data)->emplace_back(name);
    return 0;
  };
  if (H5Aiterate2(owner.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names) < 0)
    state_->fail("list the attributes of", member);
  return names;
}

bool Group::has_attribute(const std::string& member, const std::string& name) const {
  const Quiet quiet;
  return H5Aexists(state_->attribute_owner(member).id(), name.c_str()) > 0;
}

std::string Group::string_attribute(const std::string& member, const std::string& name) const {
  const Quiet quiet;
  const Handle attribute = state_->open_attribute(member, name, true);
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  if (H5Tis_variable_str(type.id()) <= 0) {  // fixed length, as other programs write it
    std::string text(H5Tget_size(type.id()), '\0');
    if (H5Aread(attribute.id(), type.id(), text.data()) < 0)
      state_->fail("read attribute " + name + " of", member);
    return text.substr(0, text.find('\0'));
  }
  char* text = nullptr;
  if (H5Aread(attribute.id(), type.id(), &text) < 0) state_->fail("read attribute " + name + " of", member);
  const std::string value = text == nullptr ? "" : text;
  H5free_memory(text);
  return value;
}

double Group::double_attribute(const std::string& member, const std::string& name) const {
  const Quiet quiet;
  const Handle attribute = state_->open_attribute(member, name, false);
  double value = 0.0;
  if (H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, &value) < 0)
    state_->fail("read attribute " + name + " of", member);
  return value;
}

std::int64_t Group::integer_attribute(const std::string& member, const std::string& name) const {
  const Quiet quiet;
  const Handle attribute = state_->open_attribute(member, name, false);
  std::int64_t value = 0;
  if (H5Aread(attribute.id(), H5T_NATIVE_INT64, &value) < 0)
    state_->fail("read attribute " + name + " of", member);
  return value;
}

}  // namespace scintray::core::h5
