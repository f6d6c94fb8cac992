#include <cstdio>
#include <cmath>
#include <cstdlib>
#include "sim/sample/icosphere.h"
#include "sim/sheet/thickness.h"
#include "tests/sim/support/dips.h"
#include "tests/support/exact_sphere.h"
using namespace hydroprint;
int main(){
  testing::DipSetting s; s.film=testing::film_of("circle:105");
  auto env=[](const char*n,double d){const char*v=std::getenv(n);return v?atof(v):d;};
  s.schedule.swept_mm=env("SWEPT",3); s.mesh.spacing_mm=env("SPACING",2); s.mesh.size={env("ATW",2.5),env("GROWTH",.7),env("MOST",25)}; s.mesh.tolerance_mm=env("TOL",.01);
  auto d=testing::solve_dip(sample::icosphere(40,5),s);
  for(size_t k=0;k<d.field.fields.size();k+=3){
    const auto& mesh=d.field.fields[k].mesh();
    auto h=sheet::thickness_mm(d.field,k,[](const auto&){return 1.0;});
    double mean=0,a=0;
    for(size_t t=0;t<h.size();++t){auto v=mesh.triangles[t];Eigen::Vector2d p=mesh.vertices_mm[v[1]]-mesh.vertices_mm[v[0]],q=mesh.vertices_mm[v[2]]-mesh.vertices_mm[v[0]];double A=p.x()*q.y()-p.y()*q.x();mean+=h[t]*A;a+=A;}
    mean/=a;
    double in=0,wl=0,inm=0,wlm=0,wlb=0;int ni=0,nw=0;
    for(size_t t=0;t<h.size();++t){bool w=false;for(int e:{0,1,2}) w|=mesh.edge_kind[mesh.triangle_edges[t][e]]==velocity::EdgeKind::kWaterline;
      double r=h[t]/mean-1; if(w){wl+=r*r;nw++;wlm=std::max(wlm,fabs(r));wlb+=r;}else{in+=r*r;ni++;inm=std::max(inm,fabs(r));}}
    printf("s %.2f theta %.1f mean %.5f (n %zu) inner rms %.4f max %.4f | waterline rms %.4f max %.4f bias %.4f\n",d.field.immersion_mm[k],acos(1-d.field.immersion_mm[k]/40)*57.3,mean,h.size(),sqrt(in/ni),inm,sqrt(wl/nw),wlm,wlb/nw);
  }
}
