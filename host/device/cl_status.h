// Names of OpenCL's status codes, and conversion of failed calls to DeviceError.
#pragma once
#include <string>

namespace sundog {

struct DeviceInfo;

/// "CL_OUT_OF_RESOURCES"; "OpenCL status -9999" for unknown codes.
std::string cl_status_name(int status);

/// CL_MEM_OBJECT_ALLOCATION_FAILURE, CL_OUT_OF_RESOURCES or CL_OUT_OF_HOST_MEMORY: smaller launches may work.
bool is_out_of_resources(int status);

/// CL_INVALID_WORK_GROUP_SIZE: a group of that size needs more registers or stack than the kernel can have.
bool is_work_group_too_large(int status);

/// Throws DeviceError "0:1 platform / device: WHAT: CL_OUT_OF_RESOURCES" unless `status` is CL_SUCCESS.
void check_cl(int status, const DeviceInfo& device, const std::string& what);

}  // namespace sundog
