import org.hipparchus.geometry.euclidean.threed.Rotation;
import org.hipparchus.geometry.euclidean.threed.Vector3D;
import org.orekit.attitudes.Attitude;
import org.orekit.attitudes.Inertia;
import org.orekit.attitudes.InertiaAxis;
import org.orekit.attitudes.TorqueFree;
import org.orekit.frames.Frame;
import org.orekit.frames.FramesFactory;
import org.orekit.time.AbsoluteDate;

/** Orekit's closed form at many times in one call, so that the way from Python is crossed once. */
public class TorqueFreeRun {
  /** start: omega (3), quaternion (x, y, z, w); returns n rows of the same. */
  public static double[] run(double[] moments, double[] start, double[] times) {
    Frame frame = FramesFactory.getGCRF();
    AbsoluteDate epoch = AbsoluteDate.ARBITRARY_EPOCH;
    // Its rotation takes space to body with the conjugate product: the same four numbers as the quaternion body to space.
    Rotation turn = new Rotation(start[6], start[3], start[4], start[5], false);
    Attitude initial = new Attitude(epoch, frame, turn, new Vector3D(start[0], start[1], start[2]), Vector3D.ZERO);
    Inertia inertia = new Inertia(new InertiaAxis(moments[0], Vector3D.PLUS_I), new InertiaAxis(moments[1], Vector3D.PLUS_J),
                                  new InertiaAxis(moments[2], Vector3D.PLUS_K));
    TorqueFree motion = new TorqueFree(initial, inertia);
    double[] out = new double[7 * times.length];
    for (int i = 0; i < times.length; ++i) {
      Attitude attitude = motion.getAttitude(null, epoch.shiftedBy(times[i]), frame);
      Vector3D w = attitude.getSpin();
      Rotation q = attitude.getRotation();
      double[] row = {w.getX(), w.getY(), w.getZ(), q.getQ1(), q.getQ2(), q.getQ3(), q.getQ0()};
      System.arraycopy(row, 0, out, 7 * i, 7);
    }
    return out;
  }
}
