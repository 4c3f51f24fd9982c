#include <string_view>

#include "c/call.hpp"
#include "c/handles.hpp"
#include "dermis/version.hpp"

using dermis::c::call;
using dermis::c::require;

const char* dermis_version(void) { return DERMIS_VERSION; }

dermis_code dermis_device_count(size_t* count) {
  return call([&] {
    require(count, "count");
    *count = dermis::Device::list().size();
  });
}

dermis_code dermis_device_open(const char* name, int threads, dermis_device** device) {
  return call([&] {
    require(device, "device");
    *device = new dermis_device{dermis::Device::open(name != nullptr ? name : "", threads)};
  });
}

dermis_code dermis_device_adopt(cl_context context, cl_device_id id, dermis_device** device) {
  return call([&] {
    require(context, "context");
    require(id, "id");
    require(device, "device");
    *device = new dermis_device{dermis::Device::adopt(context, id)};
  });
}

const char* dermis_device_name(const dermis_device* device) { return device->device.info().name.c_str(); }
const char* dermis_device_type(const dermis_device* device) { return device->device.info().type.c_str(); }
cl_context dermis_device_context(const dermis_device* device) { return device->device.context(); }
cl_device_id dermis_device_id(const dermis_device* device) { return device->device.id(); }
void dermis_device_release(dermis_device* device) { delete device; }
