// Orekit's closed form of a free body at n uniform times, for benchmarks/exact_peers.py:
//   java -cp JARS OrekitTorqueFree.java I1 I2 I3 w1 w2 w3 end n
// Prints the least nanoseconds of a run, set-up included, then a line for each state: omega, attitude (x, y, z, w).
import org.hipparchus.geometry.euclidean.threed.Rotation;
import org.hipparchus.geometry.euclidean.threed.Vector3D;
import org.orekit.attitudes.Attitude;
import org.orekit.attitudes.Inertia;
import org.orekit.attitudes.InertiaAxis;
import org.orekit.attitudes.TorqueFree;
import org.orekit.frames.Frame;
import org.orekit.frames.FramesFactory;
import org.orekit.time.AbsoluteDate;
import org.orekit.utils.AbsolutePVCoordinates;

public class OrekitTorqueFree {
  public static void main(String[] arguments) {
    double[] a = java.util.Arrays.stream(arguments).mapToDouble(Double::parseDouble).toArray();
    int n = (int) a[7];
    Frame frame = FramesFactory.getEME2000();
    AbsoluteDate start = AbsoluteDate.J2000_EPOCH;
    AbsolutePVCoordinates place = new AbsolutePVCoordinates(frame, start, Vector3D.PLUS_I, Vector3D.PLUS_J);
    Attitude[] found = new Attitude[n];
    long best = Long.MAX_VALUE;
    for (int repeat = 0; repeat < 500; ++repeat) {
      long begin = System.nanoTime();
      Inertia inertia = new Inertia(new InertiaAxis(a[0], Vector3D.PLUS_I), new InertiaAxis(a[1], Vector3D.PLUS_J),
                                    new InertiaAxis(a[2], Vector3D.PLUS_K));
      TorqueFree motion = new TorqueFree(
          new Attitude(start, frame, Rotation.IDENTITY, new Vector3D(a[3], a[4], a[5]), Vector3D.ZERO), inertia);
      for (int k = 0; k < n; ++k) found[k] = motion.getAttitude(place, start.shiftedBy(a[6] * k / (n - 1)), frame);
      best = Math.min(best, System.nanoTime() - begin);
    }
    System.out.println(best);
    for (Attitude s : found) {
      Vector3D w = s.getSpin();
      Rotation q = s.getRotation();  // space to body; its quaternion is the conjugate of the usual one
      System.out.println(w.getX() + " " + w.getY() + " " + w.getZ() + " " + q.getQ1() + " " + q.getQ2() + " " + q.getQ3()
                         + " " + q.getQ0());
    }
  }
}
