/* vec_x86.h - operations that all instruction sets of x86-64 have, by their prefix MM. What they are: vec_scalar.h.
 * SPDX-License-Identifier: MIT */
static inline vd vd_set1(double a) { return MM(set1_pd)(a); }
static inline vd vd_load(const double *p) { return MM(load_pd)(p); }
static inline vd vd_loadu(const double *p) { return MM(loadu_pd)(p); }
static inline void vd_store(double *p, vd a) { MM(store_pd)(p, a); }
static inline void vd_storeu(double *p, vd a) { MM(storeu_pd)(p, a); }
static inline vd vd_sqrt(vd a) { return MM(sqrt_pd)(a); }
static inline vd vd_min(vd a, vd b) { return MM(min_pd)(a, b); }
static inline vd vd_max(vd a, vd b) { return MM(max_pd)(a, b); }

static inline vf vf_set1(float a) { return MM(set1_ps)(a); }
static inline vf vf_load(const float *p) { return MM(load_ps)(p); }
static inline void vf_storeu(float *p, vf a) { MM(storeu_ps)(p, a); }
static inline vf vf_sqrt(vf a) { return MM(sqrt_ps)(a); }
static inline vf vf_min(vf a, vf b) { return MM(min_ps)(a, b); }
static inline vf vf_max(vf a, vf b) { return MM(max_ps)(a, b); }
