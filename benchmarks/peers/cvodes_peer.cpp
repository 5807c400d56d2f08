#include "cvodes_peer.hpp"

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_band.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_band.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#include <sunnonlinsol/sunnonlinsol_newton.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace peers {

namespace {

constexpr long most_steps = 100'000'000;

void require(int flag, const char* what) {
    if (flag < 0)
        throw std::runtime_error(std::string("CVODES: ") + what + " failed with " + std::to_string(flag));
}

template <class Pointer>
Pointer require(Pointer pointer, const char* what) {
    if (!pointer)
        throw std::runtime_error(std::string("CVODES: ") + what + " failed");
    return pointer;
}

} // namespace

class CvodesPeer::Integrator {
public:
    Integrator(const Motion<double>& motion, std::vector<double> state_scales, std::vector<double> input_scales,
               CvodesMethod method, double tolerance, bool carried)
        : motion_(&motion), count_(motion.states()), inputs_(carried ? count_ + 1 : 0), work_(3 * count_),
          state(count_), derivatives(inputs_ * count_) {
        require(SUNContext_Create(nullptr, &context_), "SUNContext_Create");
        y_ = vector();
        N_Vector absolute = vector();
        for (std::size_t i = 0; i < count_; ++i)
            data(absolute)[i] = tolerance * state_scales[i];
        memory_ = require(CVodeCreate(method.stiff ? CV_BDF : CV_ADAMS, context_), "CVodeCreate");
        require(CVodeInit(memory_, rates, 0, y_), "CVodeInit");
        require(CVodeSVtolerances(memory_, tolerance, absolute), "CVodeSVtolerances");
        require(CVodeSetUserData(memory_, this), "CVodeSetUserData");
        require(CVodeSetMaxNumSteps(memory_, most_steps), "CVodeSetMaxNumSteps");
        require(CVodeSetNoInactiveRootWarn(memory_), "CVodeSetNoInactiveRootWarn");
        N_VDestroy(absolute);
        choose_solver(method.stiff);
        if (inputs_ > 0)
            carry(method, tolerance, state_scales, input_scales);
    }
    ~Integrator() {
        CVodeFree(&memory_);
        for (SUNNonlinearSolver solver : nonlinear_)
            SUNNonlinSolFree(solver);
        if (linear_)
            SUNLinSolFree(linear_);
        if (matrix_)
            SUNMatDestroy(matrix_);
        if (s_)
            N_VDestroyVectorArray(s_, static_cast<int>(inputs_));
        N_VDestroy(y_);
        SUNContext_Free(&context_);
    }
    Integrator(const Integrator&) = delete;
    Integrator& operator=(const Integrator&) = delete;

    void run(const std::vector<double>& start, std::size_t mode, double end) {
        std::copy(start.begin(), start.end(), data(y_));
        for (std::size_t j = 0; j < inputs_; ++j) {
            N_VConst(0, s_[j]);
            if (j < count_)
                data(s_[j])[j] = 1;
        }
        meetings.clear();
        steps = 0;
        enter(mode, 0);
        require(CVodeSetStopTime(memory_, end), "CVodeSetStopTime");
        for (double time = 0;;) {
            const int flag = CVode(memory_, end, y_, &time, CV_NORMAL);
            require(flag, "CVode");
            double at = 0;
            if (inputs_ > 0)
                require(CVodeGetSens(memory_, &at, s_), "CVodeGetSens");
            if (flag != CV_ROOT_RETURN)
                break;
            count_steps();
            cross(time);
            require(CVodeSetStopTime(memory_, end), "CVodeSetStopTime");
        }
        count_steps();
        std::copy(data(y_), data(y_) + count_, state.begin());
        for (std::size_t j = 0; j < inputs_; ++j)
            std::copy(data(s_[j]), data(s_[j]) + count_, derivatives.begin() + static_cast<std::ptrdiff_t>(j * count_));
    }

private:
    static double* data(N_Vector vector) { return N_VGetArrayPointer(vector); }
    static Integrator& self(void* user) { return *static_cast<Integrator*>(user); }
    N_Vector vector() const {
        return require(N_VNew_Serial(static_cast<sunindextype>(count_), context_), "N_VNew_Serial");
    }

    void choose_solver(bool stiff) {
        nonlinear_.push_back(
            require(stiff ? SUNNonlinSol_Newton(y_, context_) : SUNNonlinSol_FixedPoint(y_, 0, context_), "a solver"));
        require(CVodeSetNonlinearSolver(memory_, nonlinear_.back()), "CVodeSetNonlinearSolver");
        if (!stiff)
            return;
        const auto size = static_cast<sunindextype>(count_),
                   lower = static_cast<sunindextype>(motion_->lower_bandwidth()),
                   upper = static_cast<sunindextype>(motion_->upper_bandwidth());
        is_band_ = 2 * lower + upper + 1 < size;
        matrix_ = require(is_band_ ? SUNBandMatrix(size, upper, lower, context_) : SUNDenseMatrix(size, size, context_),
                          "a matrix");
        linear_ = require(is_band_ ? SUNLinSol_Band(y_, matrix_, context_) : SUNLinSol_Dense(y_, matrix_, context_),
                          "a linear solver");
        require(CVodeSetLinearSolver(memory_, linear_, matrix_), "CVodeSetLinearSolver");
        require(CVodeSetJacFn(memory_, jacobian), "CVodeSetJacFn");
    }

    void carry(CvodesMethod method, double tolerance, const std::vector<double>& state_scales,
               const std::vector<double>& input_scales) {
        const int count = static_cast<int>(inputs_);
        corrector_ = method.staggered ? CV_STAGGERED : CV_SIMULTANEOUS;
        s_ = require(N_VCloneVectorArray(count, y_), "N_VCloneVectorArray");
        require(CVodeSensInit(memory_, count, corrector_, derivative_rates, s_), "CVodeSensInit");
        N_Vector* absolute = require(N_VCloneVectorArray(count, y_), "N_VCloneVectorArray");
        for (std::size_t j = 0; j < inputs_; ++j)
            for (std::size_t i = 0; i < count_; ++i)
                data(absolute[j])[i] = tolerance * state_scales[i] / input_scales[j];
        require(CVodeSensSVtolerances(memory_, tolerance, absolute), "CVodeSensSVtolerances");
        N_VDestroyVectorArray(absolute, count);
        require(CVodeSetSensErrCon(memory_, SUNTRUE), "CVodeSetSensErrCon");
        const int together = method.staggered ? count : count + 1;
        nonlinear_.push_back(require(method.stiff ? SUNNonlinSol_NewtonSens(together, y_, context_)
                                                  : SUNNonlinSol_FixedPointSens(together, y_, 0, context_),
                                     "a solver"));
        require(method.staggered ? CVodeSetNonlinearSolverSensStg(memory_, nonlinear_.back())
                                 : CVodeSetNonlinearSolverSensSim(memory_, nonlinear_.back()),
                "CVodeSetNonlinearSolverSens");
        columns_.resize(inputs_);
        column_rates_.resize(inputs_);
    }

    /// Starts an arc at the current state and derivatives.
    void enter(std::size_t mode, double time) {
        mode_ = mode;
        require(CVodeReInit(memory_, time, y_), "CVodeReInit");
        if (inputs_ > 0)
            require(CVodeSensReInit(memory_, corrector_, s_), "CVodeSensReInit");
        const int surfaces = static_cast<int>(motion_->surfaces(mode));
        require(CVodeRootInit(memory_, surfaces, distances), "CVodeRootInit");
        met_.resize(static_cast<std::size_t>(surfaces));
        std::vector<int> falling(met_.size(), -1);
        if (surfaces > 0)
            require(CVodeSetRootDirection(memory_, falling.data()), "CVodeSetRootDirection");
    }

    void cross(double time) {
        require(CVodeGetRootInfo(memory_, met_.data()), "CVodeGetRootInfo");
        std::vector<double*> columns;
        for (std::size_t j = 0; j < inputs_; ++j)
            columns.push_back(data(s_[j]));
        const std::size_t surface = static_cast<std::size_t>(
            std::find_if(met_.begin(), met_.end(), [](int m) { return m != 0; }) - met_.begin());
        if (surface == met_.size())
            throw std::runtime_error("CVODES: a root without a surface");
        meetings.push_back({time, mode_, surface});
        enter(cross_with_derivatives<double>(*motion_, mode_, surface, data(y_), columns, work_.data()), time);
    }

    void count_steps() {
        long more = 0;
        require(CVodeGetNumSteps(memory_, &more), "CVodeGetNumSteps");
        steps += more;
    }

    static int rates(realtype, N_Vector y, N_Vector rate, void* user) {
        self(user).motion_->rates(self(user).mode_, data(y), data(rate));
        return 0;
    }
    static int derivative_rates(int count, realtype, N_Vector y, N_Vector, N_Vector* s, N_Vector* rate, void* user,
                                N_Vector, N_Vector) {
        Integrator& own = self(user);
        for (std::size_t j = 0; j < static_cast<std::size_t>(count); ++j) {
            own.columns_[j] = data(s[j]);
            own.column_rates_[j] = data(rate[j]);
        }
        own.motion_->derivative_rates(own.mode_, data(y), own.columns_, own.column_rates_);
        return 0;
    }
    static int jacobian(realtype, N_Vector y, N_Vector, SUNMatrix matrix, void* user, N_Vector, N_Vector, N_Vector) {
        const Integrator& own = self(user);
        own.motion_->jacobian(own.mode_, data(y), [&](std::size_t row, std::size_t column, double value) {
            const auto i = static_cast<sunindextype>(row), j = static_cast<sunindextype>(column);
            if (own.is_band_)
                SM_ELEMENT_B(matrix, i, j) = value;
            else
                SM_ELEMENT_D(matrix, i, j) = value;
        });
        return 0;
    }
    static int distances(realtype, N_Vector y, realtype* values, void* user) {
        self(user).motion_->distances(self(user).mode_, data(y), values);
        return 0;
    }

    const Motion<double>* motion_;
    std::size_t count_, inputs_, mode_ = 0;
    std::vector<double> work_;
    std::vector<int> met_;
    std::vector<const double*> columns_;
    std::vector<double*> column_rates_;
    SUNContext context_ = nullptr;
    void* memory_ = nullptr;
    N_Vector y_ = nullptr;
    N_Vector* s_ = nullptr;
    int corrector_ = CV_SIMULTANEOUS;
    std::vector<SUNNonlinearSolver> nonlinear_;
    SUNMatrix matrix_ = nullptr;
    SUNLinearSolver linear_ = nullptr;
    bool is_band_ = false;

public:
    std::vector<double> state, derivatives;
    std::vector<Meeting> meetings;
    long steps = 0;
};

CvodesPeer::CvodesPeer(const Motion<double>& motion, std::vector<double> state_scales, std::vector<double> input_scales,
                       CvodesMethod method, double tolerance, bool derivatives)
    : integrator_(std::make_unique<Integrator>(motion, std::move(state_scales), std::move(input_scales), method,
                                               tolerance, derivatives)) {}
CvodesPeer::~CvodesPeer() = default;
CvodesPeer::CvodesPeer(CvodesPeer&&) noexcept = default;

void CvodesPeer::run(const std::vector<double>& start, std::size_t mode, double end) {
    integrator_->run(start, mode, end);
}
const std::vector<double>& CvodesPeer::state() const {
    return integrator_->state;
}
const std::vector<double>& CvodesPeer::derivatives() const {
    return integrator_->derivatives;
}
const std::vector<Meeting>& CvodesPeer::meetings() const {
    return integrator_->meetings;
}
long CvodesPeer::steps() const {
    return integrator_->steps;
}

} // namespace peers
