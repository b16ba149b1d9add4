__version__: str

from . import (
    attitude as attitude,
)
from . import (
    designs as designs,
)
from . import (
    dynamics as dynamics,
)
from . import (
    engine as engine,
)
from . import (
    ensembles as ensembles,
)
from . import (
    flight as flight,
)
from . import (
    ground as ground,
)
from . import (
    history as history,
)
from . import (
    laws as laws,
)
from . import (
    model as model,
)
from . import (
    motion as motion,
)
from . import (
    planning as planning,
)
from . import (
    rigid as rigid,
)
from . import (
    robot as robot,
)
from . import (
    simulation as simulation,
)
from . import (
    spec as spec,
)
from . import (
    stability as stability,
)
from . import (
    thesis as thesis,
)
from . import (
    view as view,
)
from ._core.errors import SomersaultError as SomersaultError
from ._core.errors import SomersaultWarning as SomersaultWarning
from .designs import (
    Choose as Choose,
)
from .designs import (
    design as design,
)
from .dynamics import Equations as Equations
from .ensembles import (
    Ensemble as Ensemble,
)
from .ensembles import (
    Vary as Vary,
)
from .ensembles import (
    ensemble as ensemble,
)
from .flight import (
    Flight as Flight,
)
from .flight import (
    JointTakeoff as JointTakeoff,
)
from .flight import (
    Landing as Landing,
)
from .flight import (
    Maneuver as Maneuver,
)
from .flight import (
    Prop as Prop,
)
from .flight import (
    Release as Release,
)
from .flight import (
    Replay as Replay,
)
from .flight import (
    Report as Report,
)
from .flight import (
    Swing as Swing,
)
from .flight import (
    Takeoff as Takeoff,
)
from .flight import (
    arm_tilt as arm_tilt,
)
from .flight import (
    cat_turn as cat_turn,
)
from .flight import (
    compliant as compliant,
)
from .flight import (
    deviated_flight as deviated_flight,
)
from .flight import (
    fly as fly,
)
from .flight import (
    hula as hula,
)
from .flight import (
    inertia_change as inertia_change,
)
from .flight import (
    off_nominal as off_nominal,
)
from .flight import (
    prescribed as prescribed,
)
from .flight import (
    released as released,
)
from .flight import (
    rudi as rudi,
)
from .flight import (
    swing as swing,
)
from .flight import (
    torque_twist as torque_twist,
)
from .flight import (
    with_momentum as with_momentum,
)
from .history import (
    History as History,
)
from .history import (
    Recording as Recording,
)
from .history import (
    read_recording as read_recording,
)
from .model import (
    Body as Body,
)
from .model import (
    Joint as Joint,
)
from .model import (
    Model as Model,
)
from .model import (
    Mount as Mount,
)
from .model import (
    athlete as athlete,
)
from .model import (
    athlete_from_measurements as athlete_from_measurements,
)
from .model import (
    load as load,
)
from .model import (
    mounted as mounted,
)
from .model import (
    named_pose as named_pose,
)
from .model import (
    sagittal as sagittal,
)
from .model import (
    shipped as shipped,
)
from .model import (
    write_mjcf as write_mjcf,
)
from .motion import (
    Motion as Motion,
)
from .motion import (
    read_motion as read_motion,
)
from .motion import (
    sampled_motion as sampled_motion,
)
from .planning import (
    plan as plan,
)
from .stability import LinearSpin as LinearSpin
from .stability import Mode as Mode
from .stability import Spin as Spin
from .stability import spin as spin
