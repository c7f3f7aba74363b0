// NVIDIA's management library with one GPU, which has used as many joules more at each call as there were
// calls before, and runs at 1980 MHz.
extern "C" {
int nvmlInit_v2() { return 0; }
int nvmlDeviceGetHandleByUUID(const char*, void**) { return 6; }
int nvmlDeviceGetHandleByIndex_v2(unsigned index, void** device) {
  static int object;
  *device = &object;
  return index == 0 ? 0 : 2;
}
int nvmlDeviceGetTotalEnergyConsumption(void*, unsigned long long* millijoules) {
  static unsigned long long calls = 0, sum = 0;
  *millijoules = sum += 1000 * calls++;
  return 0;
}
int nvmlDeviceGetClockInfo(void*, unsigned, unsigned* mhz) {
  *mhz = 1980;
  return 0;
}
}
